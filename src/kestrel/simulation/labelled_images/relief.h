// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace kestrel {

// Deviation of a board from flatness: heights over the plane z = 0, within a square around the
// origin whose rim stays on the plane. Metres.
struct Relief {
  double size_m = 1.5;  // side of the square, whose sides are along the diagonals of x and y like
                        // the board's
  double bulge_m = 0;   // height of the middle; negative: the board sags
  double fold_m = 0;    // height of the creases of a sheet that was folded to a third of its width
                        // in both directions, alternately up and down

  bool IsFlat() const { return bulge_m == 0 && fold_m == 0; }

  // Returns the height of the sheet above a point of the plane; 0 outside of the square.
  double HeightAt(const Eigen::Vector2d& point) const;

  // Returns every violation in words; empty when the sheet can exist.
  std::vector<std::string> Validate() const;
};

}  // namespace kestrel
