// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/image/convex_hull.h"

#include <algorithm>

namespace kestrel {

ConvexHull::ConvexHull(Points points) {
  // The ends of the rows contain the hull. One side is followed down, the other one up.
  struct Row {
    int left = 1 << 16;
    int right = -1;
  };
  std::array<Row, kMaxHeight + 1> rows;
  int top = points[0].y, bottom = points[0].y;
  for (const GridPoint& point : points) {
    top = std::min<int>(top, point.y);
    bottom = std::max<int>(bottom, point.y);
  }
  const int last = std::min(bottom - top, kMaxHeight);
  for (const GridPoint& point : points) {
    Row& row = rows[std::min(point.y - top, last)];
    row.left = std::min<int>(row.left, point.x);
    row.right = std::max<int>(row.right, point.x);
  }
  // A border is connected, so it has points in every row.
  const auto corner = [&](int x, int row) { return Eigen::Vector2d(x - 0.5, top + row - 0.5); };
  for (int row = 0; row <= last; ++row) Append(corner(rows[row].right, row), 0);
  const std::size_t turn = count_;
  for (int row = last; row >= 0; --row) Append(corner(rows[row].left, row), turn);
}

// Appends a point to the convex chain that starts at corner 'first' and removes corners that would
// be dents.
void ConvexHull::Append(const Eigen::Vector2d& point, std::size_t first) {
  const auto is_dent = [&] {
    const Eigen::Vector2d before = corners_[count_ - 1] - corners_[count_ - 2];
    const Eigen::Vector2d behind = point - corners_[count_ - 1];
    return before.x() * behind.y() - before.y() * behind.x() <= 0;
  };
  while (count_ >= first + 2 && is_dent()) --count_;
  corners_[count_++] = point;
}

}  // namespace kestrel
