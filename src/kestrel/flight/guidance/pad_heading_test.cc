// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/pad_heading.h"

#include <cmath>

#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

constexpr double kSigma = Radians(3);
Time Second(double s) { return TimeFromNanoseconds(std::llround(1e9 * s)); }

// A ring with a cross looks the same after each quarter turn, and a frame shows any of them.
TEST(PadHeadingTest, FramesOfAnyQuarterMakeOneHeading) {
  Random random(3);
  PadHeading heading;
  for (int i = 0; i < 40; ++i) {
    heading.Add(Second(10 + 0.06 * i), Radians(20 + 90 * (i % 4)) + kSigma * random.Normal(),
                kSigma, 4);
  }
  const auto estimate = heading.At(Second(12.4));
  ASSERT_TRUE(estimate);
  EXPECT_DOUBLE_EQ(estimate->yaw_period, kFullTurn / 4);
  const double error = std::remainder(estimate->motion.yaw() - Radians(20), kFullTurn / 4);
  const double variance = estimate->motion.covariance(TurnState::kYaw, TurnState::kYaw);
  EXPECT_LT(std::abs(error), 3 * std::sqrt(variance));
  EXPECT_LT(variance, kSigma * kSigma / 3);
}

// Tags on the board of a ring are not seen in each frame, and not from far away.
TEST(PadHeadingTest, FrameThatShowsMoreDecidesAndOneThatShowsLessDoesNot) {
  PadHeading heading;
  heading.Add(Second(10), Radians(20), kSigma, 4);
  heading.Add(Second(10.1), Radians(290), kSigma, 1);
  for (int i = 2; i < 20; ++i) heading.Add(Second(10 + 0.1 * i), Radians(20), kSigma, 4);
  const auto estimate = heading.At(Second(12));
  EXPECT_DOUBLE_EQ(estimate->yaw_period, kFullTurn);
  EXPECT_NEAR(std::remainder(estimate->motion.yaw() - Radians(290), kFullTurn), 0, 1e-9);
}

TEST(PadHeadingTest, OneWrongFrameIsOutvotedAmongFramesThatShowLess) {
  PadHeading heading;
  heading.Add(Second(10), Radians(110), kSigma, 1);
  for (int i = 1; i < 40; ++i) {
    heading.Add(Second(10 + 0.1 * i), Radians(20), kSigma, i % 2 == 0 ? 1 : 4);
  }
  EXPECT_NEAR(heading.At(Second(14))->motion.yaw(), Radians(20), Radians(1));
}

TEST(PadHeadingTest, PadWithoutHeadingHasNone) {
  PadHeading heading;
  heading.Add(Second(10), 0.3, kSigma, 0);
  EXPECT_FALSE(heading.At(Second(10)));
}

TEST(PadHeadingTest, UnseenPadIsKnownLessAndLess) {
  PadHeading heading;
  heading.Add(Second(10), 0.3, kSigma, 1);
  const auto variance = [&](double s) {
    return heading.At(Second(s))->motion.covariance(TurnState::kYaw, TurnState::kYaw);
  };
  EXPECT_GT(variance(14), 2 * variance(10));
}

TEST(PadHeadingTest, OtherPadIsTakenAfterSomeFrames) {
  PadHeading heading;
  const auto yaw_after = [&](double s, int frames) {
    for (int i = 0; i < frames; ++i) heading.Add(Second(s + 0.06 * i), 2.3, kSigma, 1);
    return heading.At(Second(s + 1))->motion.yaw();
  };
  for (int i = 0; i < 10; ++i) heading.Add(Second(10 + 0.06 * i), 0.3, kSigma, 1);
  EXPECT_NEAR(yaw_after(11, 1), 0.3, 0.01) << "one frame may be wrong";
  EXPECT_NEAR(yaw_after(12, 12), 2.3, 0.01);
}

}  // namespace
}  // namespace kestrel
