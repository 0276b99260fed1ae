// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace kestrel {

// `kestrel help [SUBCOMMAND]`: the same as --help.
void AddHelpCommand(CLI::App* app);

}  // namespace kestrel
