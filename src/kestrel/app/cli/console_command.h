// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace kestrel {

// `kestrel console SOURCE...`: shows a recording on a web page.
void AddConsoleCommand(CLI::App* app);

}  // namespace kestrel
