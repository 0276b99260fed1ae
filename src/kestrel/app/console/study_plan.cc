// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/study_plan.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <string_view>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/core/base/shown.h"

namespace kestrel {
namespace {

constexpr std::string_view kSeparator = ", ";  // of the values in the name of a grid's member

void AddSetting(std::string_view setting, std::vector<std::string>* arguments) {
  arguments->emplace_back("--set");
  arguments->emplace_back(setting);
}

// True for the name of a grid's member, as "strict landing.gate=9, landing.still=true".
bool IsMember(std::string_view name, const std::string& grid) {
  return name.starts_with(grid + " ");
}

void AddValues(std::string_view values, std::vector<std::string>* arguments) {
  while (!values.empty()) {
    const std::size_t end = std::min(values.find(kSeparator), values.size());
    AddSetting(values.substr(0, end), arguments);
    values.remove_prefix(std::min(end + kSeparator.size(), values.size()));
  }
}

}  // namespace

StudyPlan::StudyPlan(const std::string& folder)
    : file_((std::filesystem::path(folder) / "study.yaml").string()) {
  try {
    Read(ReadFile(file_));
  } catch (const YAML::Exception& error) {
    throw InputError(
        fmt::format("{}:{}: not the plan of a study: {}", file_, error.mark.line + 1, error.msg));
  }
}

void StudyPlan::Read(const std::string& text) {
  const YAML::Node plan = YAML::Load(text);
  if (!plan.IsMap()) throw InputError(file_ + ": not the plan of a study, expected keys");
  if (plan["arguments"]) arguments_ = plan["arguments"].as<std::vector<std::string>>();
  if (!plan["configurations"]) configurations_.push_back({"default", {}});
  // Relative paths are seen from the folder of the user's file, beside which the results lie.
  const std::filesystem::path base = std::filesystem::absolute(file_).parent_path().parent_path();
  for (const YAML::Node& entry : plan["configurations"]) {
    if (!entry["name"]) {
      throw InputError(
          fmt::format("{}:{}: a configuration has no 'name'", file_, entry.Mark().line + 1));
    }
    Configuration found{entry["name"].as<std::string>(), {}};
    if (entry["config"]) {
      const auto config = base / entry["config"].as<std::string>();
      found.arguments = {"--config", config.string()};
    }
    for (const auto& option : entry["set"]) {
      if (option.second.IsSequence()) continue;  // a grid
      AddSetting(option.first.as<std::string>() + "=" + option.second.as<std::string>(),
                 &found.arguments);
    }
    configurations_.push_back(std::move(found));
  }
}

std::size_t StudyPlan::PlaceOf(const std::string& configuration) const {
  std::size_t place = configurations_.size(), length = 0;
  for (std::size_t i = 0; i < configurations_.size(); ++i) {
    const std::string& name = configurations_[i].name;
    const bool fits = configuration == name || IsMember(configuration, name);
    // The longest that fits: "strict still" is no member of "strict" when the plan has both.
    if (!fits || (place < configurations_.size() && name.size() < length)) continue;
    place = i;
    length = name.size();
  }
  return place;
}

std::vector<std::string> StudyPlan::ArgumentsOf(const std::string& configuration) const {
  const std::size_t place = PlaceOf(configuration);
  if (place == configurations_.size()) {
    throw InputError(
        fmt::format("{}: has no configuration '{}' any more", file_, Shown(configuration)));
  }
  const Configuration& found = configurations_[place];
  std::vector<std::string> arguments = arguments_;
  std::copy(found.arguments.begin(), found.arguments.end(), std::back_inserter(arguments));
  if (configuration != found.name) {
    AddValues(std::string_view(configuration).substr(found.name.size() + 1), &arguments);
  }
  return arguments;
}

}  // namespace kestrel
