// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace kestrel {

// Names of the sizes of paper, largest first: a0 to a4.
std::vector<std::string> PaperNames();

// Width and height in m of a sheet, upright (ISO 216); nothing for another name.
std::optional<Eigen::Vector2d> PaperSize(std::string_view name);

// A square board cut into equal tiles, one a sheet, that meet without overlap. Metres; x to the
// right, y down from the upper left corner of sheet or board.
struct Tiling {
  Eigen::Vector2d sheet;          // its size
  Eigen::Vector2d tile;           // its size
  Eigen::Vector2d tile_on_sheet;  // upper left corner
  int rows;
  int columns;

  int count() const { return rows * columns; }
  // Upper left corner of a tile; row and column count from 0.
  Eigen::Vector2d TileOnBoard(int row, int column) const {
    return {column * tile.x(), row * tile.y()};
  }
};

// The tiling with the fewest sheets, upright or on their side, with room around each tile for what
// printers leave white and for marks. 'paper': size of an upright sheet. Throws InputError when the
// board needs more sheets than anyone glues.
Tiling TileBoard(double board_size_m, const Eigen::Vector2d& paper);

}  // namespace kestrel
