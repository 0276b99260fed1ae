// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/vision/search/pad_alignment.h"
#include "kestrel/vision/tags/tag_board.h"

namespace kestrel {

// A tag as the detector needs it. Its strokes are its cells.
struct TagModel : PadPart {
  int id = 0;
  double size_m = 0;
  int most_wrong = 0;  // bits that may be misread: with more it may be something else
  PrintedTag printed;
  bool dark_inside = true;  // whether the square that the size refers to is dark inside its edge
  RigidTransform board_from_tag;
  std::vector<Eigen::Vector2d> cell_centers;  // on the board, of all cells of the grid
  std::vector<bool> is_data;                  // one for each cell: what distinguishes tags

  const TagGrid& grid() const { return printed.grid; }
  std::size_t cell_count() const { return printed.grid.cells.size(); }
};

// All that a detector reads of a board, computed once.
struct BoardModel {
  // 'board' must be valid.
  explicit BoardModel(const TagBoard& board);

  std::vector<TagModel> tags;  // in the order of the board
  std::size_t most_cells = 0;  // in the largest tag
  double radius_m = 0;         // circle about the board's origin around all tags
};

}  // namespace kestrel
