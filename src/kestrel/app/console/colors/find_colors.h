// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "kestrel/app/console/colors/color_page.h"
#include "kestrel/io/bags/open_recording.h"

namespace kestrel {

// Returns the source for the page of colours; nothing when the recording is gray. 'model': file of
// the initial model; empty: the one in 'folder', where the page saves, or else the built-in one.
std::optional<ColorSource> FindColors(RecordingChoice choice, const std::string& model,
                                      const std::string& folder);

}  // namespace kestrel
