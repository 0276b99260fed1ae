// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace kestrel {

// `kestrel evaluate RECORDING OUTPUT`: compares an output folder with the recording's truth.
void AddEvaluateCommand(CLI::App* app);

}  // namespace kestrel
