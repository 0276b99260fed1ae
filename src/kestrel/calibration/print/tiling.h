// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace kestrel {

// Returns the names of the paper sizes, largest first: a0 to a4.
std::vector<std::string> PaperNames();

// Returns width and height (m) of an upright sheet (ISO 216); nothing for another name.
std::optional<Eigen::Vector2d> PaperSize(std::string_view name);

// A square board cut into equal tiles, one per sheet, that meet without overlap; or the part of it
// that one sheet holds. In metres; x to the right, y down from the upper left corner of sheet or
// board.
struct Tiling {
  Eigen::Vector2d sheet;                                 // size of a sheet
  Eigen::Vector2d tile;                                  // size of a tile
  Eigen::Vector2d tile_on_sheet;                         // upper left corner
  Eigen::Vector2d first_tile = Eigen::Vector2d::Zero();  // upper left corner, on the board
  int rows;
  int columns;

  int count() const { return rows * columns; }
  // Returns the upper left corner of a tile; row and column count from 0.
  Eigen::Vector2d TileOnBoard(int row, int column) const {
    return first_tile + Eigen::Vector2d(column * tile.x(), row * tile.y());
  }
};

// Returns the tiling with the fewest sheets, upright or on their sides, with room around each tile
// for the printer's margins and for marks. 'paper': size of an upright sheet. Throws InputError
// when the board needs more than 1000 sheets.
Tiling TileBoard(double board_size_m, const Eigen::Vector2d& paper);

// Returns one upright sheet, with as much of the board's middle as it has room for; nothing where
// that is less than 'ink_m', the side of what is printed on the board.
std::optional<Tiling> OneSheet(double board_size_m, double ink_m, const Eigen::Vector2d& paper);

}  // namespace kestrel
