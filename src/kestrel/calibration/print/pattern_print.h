// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/calibration/print/tiling.h"
#include "kestrel/vision/landing/landing_pattern.h"

namespace kestrel {

// The landing pattern as a file to be printed, true to scale, its arms on the diagonals of the
// board. All throw InputError when the pattern is not valid or the file cannot be written. Programs
// that print the same write the same bytes.

// Length (m) of the ruler that is printed beside the pattern.
double RulerLength(const LandingPattern& pattern);

// One page as large as the board, with dimensions and rulers, small and gray, in its corners. A PDF
// has no page above 5.08 m: such a board is an InputError.
void PrintPatternPdf(const LandingPattern& pattern, const std::string& file);
void PrintPatternSvg(const LandingPattern& pattern, const std::string& file);

// First an overview with the dimensions and what to do, then one page a tile, row by row, with
// marks where to cut, the tile's place and a ruler. An SVG is one page: the overview, or a tile
// (from 0).
void PrintTilesPdf(const LandingPattern& pattern, const Tiling& tiling, const std::string& file);
void PrintOverviewSvg(const LandingPattern& pattern, const Tiling& tiling, const std::string& file);
void PrintTileSvg(const LandingPattern& pattern, const Tiling& tiling, int row, int column,
                  const std::string& file);

}  // namespace kestrel
