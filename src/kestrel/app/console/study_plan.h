// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace kestrel {

// The plan of a study, study.yaml beside its results: the arguments and options with which its
// configurations were run.
class StudyPlan {
 public:
  // Reads the plan in the folder of a study. Throws InputError when there is none, or it is not
  // valid.
  explicit StudyPlan(const std::string& folder);

  // Returns the arguments of the command for a configuration by its name in the results, as
  // {"--still", "--config", "a.yaml", "--set", "landing.still=true"}. Throws InputError when the
  // plan has no such configuration.
  std::vector<std::string> ArgumentsOf(const std::string& configuration) const;

  // Returns the place of a configuration among those of the plan; behind all of them when it is
  // not one.
  std::size_t PlaceOf(const std::string& configuration) const;

 private:
  struct Configuration {
    std::string name;
    std::vector<std::string> arguments;  // without the values of a grid, which the results name
  };

  void Read(const std::string& text);

  std::string file_;
  std::vector<std::string> arguments_;  // arguments of all configurations
  std::vector<Configuration> configurations_;
};

}  // namespace kestrel
