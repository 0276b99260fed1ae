// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "kestrel/app/cli/source_arguments.h"
#include "kestrel/app/console/color_page.h"

namespace kestrel {

// What the console's page teaches colours by; nothing when the recording is gray. 'model': the file
// to begin with; empty: that of 'folder', where the page saves, or the built-in one.
std::optional<ColorSource> FindColors(const SourceArguments& source, const std::string& model,
                                      const std::string& folder);

}  // namespace kestrel
