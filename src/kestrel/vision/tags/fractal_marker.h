// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "kestrel/vision/tags/tag_board.h"

namespace kestrel {

// Returns whether a file describes a fractal marker of the library ArUco.
bool IsFractalMarker(std::string_view text);

// Reads a fractal marker (Romero-Ramirez, Munoz-Salinas, Medina-Carnicer 2019) from the file that
// the library ArUco writes and reads: markers inside each other, each with its bits and the corners
// of its square (upper left, upper right, lower right, lower left; x right, y up). They become tags
// of no family, "fractal" by name, the largest first; a tag does without the cells that another one
// covers. 'size_m': side of the largest square, unless the file has metres. Throws InputError that
// names 'file', line and key. The board may be invalid.
TagBoard ParseFractalMarker(const std::string& text, const std::string& file, double size_m);

}  // namespace kestrel
