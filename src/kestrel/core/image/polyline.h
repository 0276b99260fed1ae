// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace kestrel {

// A straight piece of a polyline. Its end points lie on the line fitted to all points of the piece.
struct LineSegment {
  Eigen::Vector2d start;
  Eigen::Vector2d end;

  double length() const { return (end - start).norm(); }
  Eigen::Vector2d direction() const { return (end - start).normalized(); }
};

// Divides a curve into straight pieces (split and merge; Ramer 1972, Pavlidis and Horowitz 1974):
// splits where a point is farther than 'tolerance' from the chord, then merges neighbours that one
// line fits within the tolerance. Keeps pieces of at least 'min_length'. 'closed': the curve is
// closed. Appends to 'segments'; 'breaks' is scratch memory. The unit is that of the points.
void SplitAndMerge(std::span<const Eigen::Vector2d> points, bool closed, double tolerance,
                   double min_length, std::vector<std::size_t>* breaks,
                   std::vector<LineSegment>* segments);

}  // namespace kestrel
