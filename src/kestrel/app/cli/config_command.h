// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace kestrel {

// `kestrel config`: prints all options with value, unit and meaning, as YAML for --config.
void AddConfigCommand(CLI::App* app);

}  // namespace kestrel
