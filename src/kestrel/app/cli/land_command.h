// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace kestrel {

// `kestrel land SOURCE...`: runs the landing pipeline over a source.
void AddLandCommand(CLI::App* app);

}  // namespace kestrel
