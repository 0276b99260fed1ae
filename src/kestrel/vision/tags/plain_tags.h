// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/vision/tags/tag_board.h"

namespace kestrel {

// Returns a line for each tag of a valid board whose picture is plain: a stripe, a block or a
// letter, as windows, buttons and prints show them (CellInformation). The line names ids of the
// same family that are told apart better.
std::vector<std::string> WarningsOfPlainTags(const TagBoard& board);

}  // namespace kestrel
