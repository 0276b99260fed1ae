// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/options/kestrel_options.h"

#include "kestrel/core/base/options.h"
#include "kestrel/core/base/violations.h"

namespace kestrel {

std::vector<std::string> KestrelOptions::Validate() const {
  std::vector<std::string> violations = TaskOptions::Validate();
  AddViolations("fly", fly.Validate(), &violations);
  AddViolations("console", console.Validate(), &violations);
  AddViolations("team", team.Validate(), &violations);
  AddViolations("dds", dds.Validate(), &violations);
  return violations;
}

KestrelOptions ReadKestrelOptions(const std::string& config_file,
                                  const std::vector<std::string>& settings) {
  KestrelOptions options;
  if (!config_file.empty()) ReadOptions(config_file, &options);
  for (const std::string& setting : settings) SetOption(setting, &options);
  RequireValid(options);
  return options;
}

}  // namespace kestrel
