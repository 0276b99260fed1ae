// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace kestrel {

// Adds `lens` to the subcommand `calibrate`.
void AddCalibrateLensCommand(CLI::App* calibrate);

}  // namespace kestrel
