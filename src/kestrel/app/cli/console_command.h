// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace kestrel {

// `kestrel console SOURCE...`: the web page on a recording.
void AddConsoleCommand(CLI::App* app);

}  // namespace kestrel
