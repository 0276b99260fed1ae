// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace kestrel {

// `kestrel calibrate colors`: fits colour models to images with marked rectangles or masks.
void AddCalibrateColorsCommand(CLI::App* calibrate);

}  // namespace kestrel
