// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/replay/replay_options.h"

#include <string_view>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/options.h"

namespace kestrel {
namespace {

// The prefix of a pipeline's options in `kestrel config`.
std::string_view PrefixOf(const LandingPipelineOptions& /*options*/) { return "landing."; }
std::string_view PrefixOf(const HuntPipelineOptions& /*options*/) { return "hunt."; }

// True for an option that the page may change: not what costs memory, and not the files that
// describe a target.
bool IsOffered(std::string_view name) {
  return !name.starts_with("target.") && name != "map.capacity" && name != "pose_gap_s";
}

std::string TextOf(const OptionField& field) {
  return std::visit([](const auto* value) { return fmt::format("{}", *value); }, field.value);
}

template <class Options>
ConsoleOptionList ListOf(Options options) {
  ConsoleOptionList list;
  for (const OptionField& field : FieldsOf(options)) {
    if (!IsOffered(field.key)) continue;
    list.options.push_back({std::string(PrefixOf(options)) + field.key, TextOf(field),
                            field.unit.empty() ? "1" : std::string(field.unit),
                            std::string(field.meaning)});
  }
  return list;
}

template <class Options>
Options Changed(Options options, const std::vector<std::string>& settings) {
  const std::string_view prefix = PrefixOf(options);
  for (const std::string& setting : settings) {
    const std::string_view name = std::string_view(setting).substr(0, setting.find('='));
    if (!name.starts_with(prefix) || !IsOffered(name.substr(prefix.size()))) {
      throw InputError(fmt::format("{}: no option that the page may change", name));
    }
    SetOption(setting.substr(prefix.size()), &options);
  }
  RequireValid(options);
  return options;
}

}  // namespace

ConsoleOptionList ReplayOptions(const LandingPipelineOptions& options) { return ListOf(options); }

ConsoleOptionList ReplayOptions(const HuntPipelineOptions& options) { return ListOf(options); }

LandingPipelineOptions WithSettings(LandingPipelineOptions options,
                                    const std::vector<std::string>& settings) {
  return Changed(std::move(options), settings);
}

HuntPipelineOptions WithSettings(HuntPipelineOptions options,
                                 const std::vector<std::string>& settings) {
  return Changed(options, settings);
}

}  // namespace kestrel
