// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/target/target_print.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace kestrel {
namespace {

using Eigen::Vector2d;

TEST(TargetPrint, RectangleRunsClockwiseFromUpperRight) {
  const auto loop = Rectangle({1, 2}, {0.4, 0.2}).loops.at(0);
  ASSERT_EQ(loop.size(), 4u);
  EXPECT_LT((loop[0] - Vector2d(1.2, 2.1)).norm(), 1e-12);
  EXPECT_LT((loop[1] - Vector2d(1.2, 1.9)).norm(), 1e-12);
  EXPECT_LT((loop[2] - Vector2d(0.8, 1.9)).norm(), 1e-12);
  EXPECT_LT((loop[3] - Vector2d(0.8, 2.1)).norm(), 1e-12);
}

TEST(TargetPrint, ShapeIsTurnedThenMoved) {
  const PrintShape ring = Moved({PrintRing{{1, 0}, 0.3, 0.1}, 0.5}, std::numbers::pi / 2, {0, 2});
  EXPECT_LT((std::get<PrintRing>(ring.area).center - Vector2d(0, 3)).norm(), 1e-12);
  EXPECT_EQ(std::get<PrintRing>(ring.area).outer_radius_m, 0.3);
  EXPECT_EQ(ring.gray, 0.5);
  const PrintShape bar = Moved({Rectangle({0, 0}, {2, 1})}, std::numbers::pi / 2, {3, 0});
  EXPECT_LT((std::get<PrintPolygon>(bar.area).loops[0][0] - Vector2d(2.5, 1)).norm(), 1e-12);
}

TEST(TargetPrint, ExtentContainsAllShapes) {
  TargetPrint print;
  EXPECT_EQ(HalfExtent(print), 0);
  print.shapes = {{PrintRing{{0.2, -0.3}, 0.1, 0}}, {Rectangle({0, 0}, {0.9, 0.2})}};
  EXPECT_DOUBLE_EQ(HalfExtent(print), 0.45);
  print.shapes.push_back({PrintRing{{0.2, -0.4}, 0.1, 0}});
  EXPECT_DOUBLE_EQ(HalfExtent(print), 0.5);
}

TEST(TargetPrint, TurnedBoardReachesFartherToItsCorners) {
  TargetPrint print{.board_size_m = 2, .board_heading = std::numbers::pi / 4};
  EXPECT_NEAR(ReachOnBoard(print, {1.2, 0}), 1.2 / std::numbers::sqrt2, 1e-12);
  EXPECT_NEAR(ReachOnBoard(print, {0.9, 0.9}), 0.9 * std::numbers::sqrt2, 1e-12);
  print.board_heading = 0;
  EXPECT_NEAR(ReachOnBoard(print, {1.2, 0}), 1.2, 1e-12);
}

TEST(TargetPrint, BoardGrowsForOverprintedShapes) {
  TargetPrint print{.board_size_m = 1, .board_heading = std::numbers::pi / 4, .dimensions = {"a"}};
  print.shapes.push_back({PrintRing{{0, 0}, 0.5, 0.4}});
  const TargetPrint small{
      .board_size_m = 0.4, .shapes = {{Rectangle({0, 0}, {0.4, 0.4}), 1}}, .dimensions = {"b"}};
  PrintOver(small, &print);
  EXPECT_EQ(print.board_size_m, 1);
  ASSERT_EQ(print.shapes.size(), 2u);
  EXPECT_EQ(print.shapes.back().gray, 1);
  EXPECT_EQ(print.dimensions.size(), 2u);
  const TargetPrint large{.board_size_m = 1};
  PrintOver(large, &print);
  EXPECT_NEAR(print.board_size_m, std::numbers::sqrt2, 1e-12);
}

}  // namespace
}  // namespace kestrel
