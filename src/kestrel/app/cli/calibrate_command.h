// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace kestrel {

// `kestrel calibrate mount|clock RECORDING`: estimates mount angles and clock offset from a flight
// over the landing pattern.
void AddCalibrateCommand(CLI::App* app);

}  // namespace kestrel
