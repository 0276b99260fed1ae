// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/evaluation/landing_truth.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/app/evaluation/test_flight.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

constexpr double kTurnRate = 0.5;

// A pattern on a circle of 8 m at 4 m/s, with a row every 0.1 s.
TruePattern OnCircle(double seconds) {
  const double angle = kTurnRate * seconds;
  TruePattern row;
  row.time = Time(DurationFromSeconds(seconds));
  row.world_from_pattern.translation = 8 * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0);
  row.velocity_in_world = 8 * kTurnRate * Eigen::Vector3d(-std::sin(angle), std::cos(angle), 0);
  return row;
}

TEST(TrueMotionAt, FollowsCurveBetweenRows) {
  std::vector<TruePattern> rows;
  for (int i = 0; i <= 20; ++i) rows.push_back(OnCircle(0.1 * i));
  for (double t = 0; t <= 2; t += 0.013) {
    const TruePattern wanted = OnCircle(t);
    const auto motion = TrueMotionAt(rows, wanted.time);
    ASSERT_TRUE(motion) << t;
    EXPECT_LT((motion->position_in_world - wanted.world_from_pattern.translation).norm(), 1e-6);
    EXPECT_LT((motion->velocity_in_world - wanted.velocity_in_world).norm(), 1e-4);
  }
}

TEST(TrueMotionAt, IsEmptyOutsideOfRowsAndInGaps) {
  const std::vector<TruePattern> rows = {OnCircle(1), OnCircle(2)};
  EXPECT_FALSE(TrueMotionAt(rows, Time(DurationFromSeconds(0.9))));
  EXPECT_TRUE(TrueMotionAt(rows, Time(DurationFromSeconds(1))));
  EXPECT_FALSE(TrueMotionAt(rows, Time(DurationFromSeconds(1.5))));
  EXPECT_FALSE(TrueMotionAt(rows, Time(DurationFromSeconds(2.1))));
  EXPECT_FALSE(TrueMotionAt({}, Time()));
}

TEST(ParseTruePatterns, ReadsRow) {
  const auto rows = ParseTruePatterns(
      std::string(kPatternHeader) + "5,1,2,3,1,0,0,0,4,5,6,320.5,240,2.5,0.75\n", "p.csv");
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].world_from_pattern.translation, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(rows[0].velocity_in_world, Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(rows[0].center_px, Eigen::Vector2d(320.5, 240));
  EXPECT_EQ(rows[0].altitude_m, 2.5);
  EXPECT_EQ(rows[0].visible_fraction, 0.75);
  EXPECT_NE(FindTruePattern(rows, TimeFromNanoseconds(5)), nullptr);
  EXPECT_EQ(FindTruePattern(rows, TimeFromNanoseconds(4)), nullptr);
}

TEST(ParseTruePatterns, ErrorsNameLine) {
  const auto error = [](const std::string& rows) {
    return InputErrorOf([&] { ParseTruePatterns(kPatternHeader + rows, "p.csv"); });
  };
  EXPECT_THAT(error("5,1,2,3,1,0,0,0,4,5,6,320,240,2,1.5\n"), HasSubstr("line 2"));
  EXPECT_THAT(error("5,1,2,3,2,0,0,0,4,5,6,320,240,2,1\n"), HasSubstr("q_WP has the length 2"));
  EXPECT_THAT(error("5,1,nan,3,1,0,0,0,4,5,6,320,240,2,1\n"),
              HasSubstr("expected a finite number"));
}

}  // namespace
}  // namespace kestrel
