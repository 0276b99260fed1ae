// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace kestrel {

void AddPrintCommand(CLI::App* app);

}  // namespace kestrel
