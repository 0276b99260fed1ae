// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/vision/tags/tag_board.h"
#include "kestrel/vision/target/target_print.h"

namespace kestrel {

// Returns the print of a valid board of tags: white squares, and the tags' black cells over them.
TargetPrint PrintOf(const TagBoard& board);

}  // namespace kestrel
