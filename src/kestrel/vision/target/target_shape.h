// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

namespace kestrel {

// Appearance of a pad, as far as it matters to those who draw it, look at its place in the image
// or tell its size. Frame P of the pad: origin in the middle of what is detected, z up out of the
// printed face; what x is, its detector says.
struct TargetShape {
  double diameter_m = 0;    // of the circle around all that is detected
  double board_size_m = 0;  // side of the square board with its margin
  // The edges of the print in frame P, m. The first one is the outermost. A lens bends lines:
  // straight edges therefore have points in between.
  std::vector<std::vector<Eigen::Vector3d>> outlines;

  double radius_m() const { return 0.5 * diameter_m; }
};

}  // namespace kestrel
