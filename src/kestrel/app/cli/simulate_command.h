// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace kestrel {

// `kestrel simulate landing|hunt`: renders a recording with truth.
void AddSimulateCommand(CLI::App* app);

}  // namespace kestrel
