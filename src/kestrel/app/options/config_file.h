// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/app/options/kestrel_options.h"

namespace kestrel {

// Sets options in a configuration file, each as "key=value". All else in it stays as it is,
// comments and order too; at any time it is complete, old or new. Throws InputError, and leaves the
// file alone, when the file or a setting is not valid, or the option is written in a way that
// cannot be changed without its neighbours.
void SaveSettings(const std::string& file, const std::vector<std::string>& settings);

// Returns the YAML with one option set. 'file': its name, for errors. Throws InputError as above.
std::string WithSetting(const std::string& yaml, const std::string& setting,
                        const std::string& file);

}  // namespace kestrel
