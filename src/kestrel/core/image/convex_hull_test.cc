// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/image/convex_hull.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kestrel {
namespace {

using ::testing::ElementsAre;

std::vector<Eigen::Vector2d> Corners(const std::vector<GridPoint>& points) {
  const ConvexHull hull(points);
  return {hull.corners().begin(), hull.corners().end()};
}

TEST(ConvexHull, OmitsDentsAndPointsOnSides) {
  const auto corners = Corners(
      {{10, 20}, {11, 20}, {12, 20}, {12, 21}, {11, 21}, {12, 22}, {11, 22}, {10, 22}, {10, 21}});
  EXPECT_THAT(corners, ElementsAre(Eigen::Vector2d(11.5, 19.5), Eigen::Vector2d(11.5, 21.5),
                                   Eigen::Vector2d(9.5, 21.5), Eigen::Vector2d(9.5, 19.5)));
}

TEST(ConvexHull, IsIndependentOfWalkDirection) {
  std::vector<GridPoint> points{{5, 0}, {6, 1}, {7, 2}, {6, 3}, {5, 4}, {4, 3}, {3, 2}, {4, 1}};
  const auto clockwise = Corners(points);
  EXPECT_THAT(clockwise, ElementsAre(Eigen::Vector2d(4.5, -0.5), Eigen::Vector2d(6.5, 1.5),
                                     Eigen::Vector2d(4.5, 3.5), Eigen::Vector2d(4.5, 3.5),
                                     Eigen::Vector2d(2.5, 1.5), Eigen::Vector2d(4.5, -0.5)));
  std::reverse(points.begin(), points.end());
  EXPECT_EQ(Corners(points), clockwise);
}

TEST(ConvexHull, CutsOffTallFiguresAtBottom) {
  std::vector<GridPoint> points;
  for (std::int16_t y = 0; y < 200; ++y) {
    points.push_back({0, y});
    points.push_back({9, y});
  }
  for (const Eigen::Vector2d& corner : Corners(points)) {
    EXPECT_LE(corner.y(), ConvexHull::kMaxHeight);
  }
}

}  // namespace
}  // namespace kestrel
