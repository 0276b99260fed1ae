// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace kestrel {

// `kestrel hunt SOURCE...`: runs the coloured-object pipeline over a source.
void AddHuntCommand(CLI::App* app);

}  // namespace kestrel
