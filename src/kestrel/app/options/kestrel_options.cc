// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/options/kestrel_options.h"

#include "kestrel/core/base/options.h"

namespace kestrel {

KestrelOptions ReadKestrelOptions(const std::string& config_file,
                                  const std::vector<std::string>& settings) {
  KestrelOptions options;
  if (!config_file.empty()) ReadOptions(config_file, &options);
  for (const std::string& setting : settings) SetOption(setting, &options);
  RequireValid(options);
  return options;
}

}  // namespace kestrel
