// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace kestrel {

// How a board that should be flat is not: heights over the plane z = 0, within a square around the
// origin whose rim stays on the plane. Metres.
struct Relief {
  double size_m = 1.5;  // side of the square, along the diagonals of x and y as the board's is
  double bulge_m = 0;   // height of the middle; negative: the board sags
  double fold_m = 0;    // height of the creases of a sheet that was folded to a third of its width
                        // in both directions, up and down in turn

  bool IsFlat() const { return bulge_m == 0 && fold_m == 0; }

  // Height of the sheet above a point of the plane; 0 outside of the square.
  double HeightAt(const Eigen::Vector2d& point) const;

  // Every violation in words; empty when the sheet can exist.
  std::vector<std::string> Validate() const;
};

}  // namespace kestrel
