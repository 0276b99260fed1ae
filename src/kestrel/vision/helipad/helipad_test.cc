// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/helipad/helipad.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/options.h"

namespace kestrel {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

double AreaOf(const std::vector<Eigen::Vector2d>& corners) {
  double area = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d& a = corners[i];
    const Eigen::Vector2d& b = corners[(i + 1) % corners.size()];
    area += 0.5 * (a.x() * b.y() - a.y() * b.x());
  }
  return area;
}

TEST(Helipad, HHasStandardProportions) {
  const Helipad helipad;
  EXPECT_DOUBLE_EQ(helipad.width_m / helipad.height_m, 1.8 / 3);
  EXPECT_DOUBLE_EQ(helipad.stroke_m / helipad.height_m, 0.4 / 3);
  const auto corners = CornersOf(helipad);
  ASSERT_EQ(corners.size(), 12u);
  const double gap = helipad.width_m - 2 * helipad.stroke_m;
  // Clockwise: the signed area is negative.
  EXPECT_NEAR(AreaOf(corners), -helipad.stroke_m * (2 * helipad.height_m + gap), 1e-12);
}

TEST(Helipad, LooksSameAfterHalfTurn) {
  const auto corners = CornersOf(Helipad());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    EXPECT_LT((corners[i] + corners[(i + 6) % 12]).norm(), 1e-12);
  }
}

TEST(Helipad, RefusesMillimetres) {
  for (double Helipad::*length :
       {&Helipad::height_m, &Helipad::width_m, &Helipad::stroke_m, &Helipad::frame_size_m,
        &Helipad::frame_width_m, &Helipad::board_size_m}) {
    Helipad helipad;
    helipad.*length *= 1000;
    EXPECT_THAT(ViolationsOf(helipad), ElementsAre(HasSubstr("expected metres: ")));
  }
  EXPECT_THAT(ViolationsOf(Helipad{.height_m = 90}),
              ElementsAre("height_m is 90, expected metres: 0.09?"));
  EXPECT_THAT(
      ViolationsOf(Helipad{
          .height_m = 3, .width_m = 1.8, .stroke_m = 0.4, .frame_size_m = 26, .board_size_m = 30}),
      IsEmpty());
}

TEST(Helipad, ChecksEachDimension) {
  EXPECT_THAT(ViolationsOf(Helipad()), IsEmpty());
  EXPECT_THAT(ViolationsOf(Helipad{.frame = "none", .frame_size_m = 0}), IsEmpty());
  EXPECT_THAT(ViolationsOf(Helipad{.height_m = 3000}).at(0), HasSubstr("height_m"));
  EXPECT_THAT(ViolationsOf(Helipad{.stroke_m = 0.4}).at(0), HasSubstr("stroke_m"));
  EXPECT_THAT(ViolationsOf(Helipad{.width_m = 0.2}).at(0), HasSubstr("width_m"));
  EXPECT_THAT(ViolationsOf(Helipad{.frame = "triangle"}).at(0), HasSubstr("triangle"));
  EXPECT_THAT(ViolationsOf(Helipad{.frame_size_m = 1.1}).at(0), HasSubstr("frame_size_m"));
  EXPECT_THAT(ViolationsOf(Helipad{.board_size_m = 1.4}).at(0), HasSubstr("board_size_m"));
  EXPECT_THAT(ViolationsOf(Helipad{.frame = "none", .board_size_m = 0.9}).at(0),
              HasSubstr("board_size_m"));
}

TEST(Helipad, PrintUsesOneInkOnBoard) {
  for (const bool white : {true, false}) {
    for (const auto& [frame, shapes] : {std::pair("circle", 2u), {"square", 2u}, {"none", 1u}}) {
      const TargetPrint print = PrintOf({.frame = frame, .white = white});
      EXPECT_EQ(print.board_gray, white ? 0 : 1);
      ASSERT_EQ(print.shapes.size(), shapes) << frame;
      for (const PrintShape& shape : print.shapes) EXPECT_EQ(shape.gray, white ? 1 : 0);
      EXPECT_FALSE(print.can_be_checked);
    }
  }
}

TEST(Helipad, ShapeMatchesH) {
  const TargetShape shape = ShapeOf(Helipad{.frame = "square"});
  EXPECT_NEAR(shape.diameter_m, std::hypot(1, 0.6), 1e-12);
  ASSERT_EQ(shape.outlines.size(), 2u);
  double largest = 0;
  for (const Eigen::Vector3d& point : shape.outlines[1]) largest = std::max(largest, point.norm());
  EXPECT_NEAR(largest, 0.5 * shape.diameter_m, 1e-12);
}

}  // namespace
}  // namespace kestrel
