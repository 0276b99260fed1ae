// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/target_arguments.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "kestrel/core/base/error.h"
#include "kestrel/vision/targets/make_target_detector.h"

namespace kestrel {
namespace {

// Adds 'section'.'key'='value'; 'option' is what the user typed for it. Throws InputError where a
// --set sets the same of the target or of one of its kinds: one of the two would be ignored.
void Add(const std::string& option, const std::string& section, const std::string& key,
         const std::string& value, std::vector<std::string>* settings) {
  for (const std::string& setting : *settings) {
    const std::string name = setting.substr(0, setting.find('='));
    if (name.starts_with(section + ".") && name.ends_with("." + key)) {
      throw InputError(
          fmt::format("{} {} and --set {}: expected one of the two", option, value, setting));
    }
  }
  settings->push_back(fmt::format("{}.{}={}", section, key, value));
}

}  // namespace

void TargetArguments::AddTo(CLI::App* command, const std::string& size_name) {
  command
      ->add_option(
          "--target", kind,
          fmt::format("The pad: {} (default: as configured)", fmt::join(TargetKinds(), ", ")))
      ->type_name("KIND");
  command->add_option("--target-id", id, "Id of the pad, where that is one tag")->type_name("ID");
  size_option_ = size_name;
  command
      ->add_option(size_name, size_m,
                   "Size of the pad (m), to which all its dimensions are scaled: outer diameter of "
                   "the ring, side of the (largest) tag, size of the helipad's frame")
      ->type_name("M");
}

void TargetArguments::AppendTo(std::vector<std::string>* settings,
                               const std::string& section) const {
  if (!kind.empty()) Add("--target", section, "kind", kind, settings);
  if (id) Add("--target-id", section, "id", fmt::format("{}", *id), settings);
  if (size_m) Add(size_option_, section, "size_m", fmt::format("{}", *size_m), settings);
}

}  // namespace kestrel
