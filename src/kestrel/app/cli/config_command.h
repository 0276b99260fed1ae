// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace kestrel {

// `kestrel config`: prints every option with its value, unit and meaning, as YAML that --config
// reads.
void AddConfigCommand(CLI::App* app);

}  // namespace kestrel
