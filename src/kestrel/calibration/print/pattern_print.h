// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/calibration/print/tiling.h"
#include "kestrel/vision/target/target_print.h"

namespace kestrel {

// Writes a pad as a file to be printed true to scale. All functions throw InputError when the file
// cannot be written. The same input gives the same bytes.

// Returns whether something of the pad is printed on a tile (row and column from 0). The others are
// blank and no sheet is made of them.
bool HasPrint(const TargetPrint& print, const Tiling& tiling, int row, int column);

// Returns the number of sheets in words: "24 sheets of 4 rows by 6", or "1 sheet".
std::string SheetsInWords(const TargetPrint& print, const Tiling& tiling);

// Returns the length (m) of the ruler that is printed beside the pad.
double RulerLength(double board_size_m);

// Write one page of the board's size, with small gray dimensions and rulers in its corners. A page
// of a PDF is at most 5.08 m: a larger board is an InputError.
void PrintPatternPdf(const TargetPrint& print, const std::string& file);
void PrintPatternSvg(const TargetPrint& print, const std::string& file);

// A pad and the sheets that it is cut into. 'note': a line beside it, such as how to fly with it.
struct TiledPrint {
  TargetPrint print;
  Tiling tiling;
  std::string note{};
};

// Write first an overview with the dimensions and instructions, then one page per tile that has
// print, row by row, with cut marks, the tile's place and a ruler; a pad on one sheet is that page
// alone, with its dimensions. Several pads, on the same paper, follow each other. An SVG has one
// page: the overview, or a tile (row and column from 0).
void PrintTilesPdf(const std::vector<TiledPrint>& pads, const std::string& file);
void PrintOverviewSvg(const TiledPrint& pad, const std::string& file);
void PrintTileSvg(const TiledPrint& pad, int row, int column, const std::string& file);

}  // namespace kestrel
