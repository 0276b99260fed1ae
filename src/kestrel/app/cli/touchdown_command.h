// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace kestrel {

// Adds `kestrel simulate touchdown` to `kestrel simulate`.
void AddTouchdownCommand(CLI::App* simulate);

}  // namespace kestrel
