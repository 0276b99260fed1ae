// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/landing_pattern.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/options.h"

namespace kestrel {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(LandingPattern, DefaultsAreValid) {
  const LandingPattern pattern{};
  EXPECT_THAT(ViolationsOf(pattern), IsEmpty());
  EXPECT_DOUBLE_EQ(pattern.outer_radius_m(), 0.5);
  EXPECT_DOUBLE_EQ(pattern.inner_radius_m(), 0.4);
}

TEST(LandingPattern, ArmsMayReachIntoRing) {
  LandingPattern pattern;
  pattern.arm_half_length_m = 0.5;
  EXPECT_THAT(ViolationsOf(pattern), IsEmpty());
  pattern.arm_half_length_m = 0.51;
  EXPECT_THAT(ViolationsOf(pattern), ElementsAre(HasSubstr("arm_half_length_m is 0.51")));
}

TEST(LandingPattern, ReportsEveryViolation) {
  LandingPattern pattern;
  pattern.ring_width_m = 0.5;
  pattern.board_size_m = 0.9;
  EXPECT_THAT(ViolationsOf(pattern), ::testing::Contains(HasSubstr("ring_width_m is 0.5")));
  EXPECT_THAT(ViolationsOf(pattern), ::testing::Contains(HasSubstr("board_size_m is 0.9")));
}

TEST(LandingPattern, RefusesMillimetres) {
  for (double LandingPattern::*length :
       {&LandingPattern::outer_diameter_m, &LandingPattern::ring_width_m,
        &LandingPattern::arm_width_m, &LandingPattern::arm_half_length_m,
        &LandingPattern::board_size_m}) {
    LandingPattern pattern;
    pattern.*length *= 1000;
    EXPECT_THAT(ViolationsOf(pattern), ElementsAre(HasSubstr("expected metres: ")));
  }
  LandingPattern pattern;
  pattern.ring_width_m = 160;
  EXPECT_THAT(ViolationsOf(pattern), ElementsAre("ring_width_m is 160, expected metres: 0.16?"));
}

TEST(LandingPattern, RefusesNanLengths) {
  for (double LandingPattern::*length :
       {&LandingPattern::outer_diameter_m, &LandingPattern::ring_width_m,
        &LandingPattern::arm_width_m, &LandingPattern::arm_half_length_m,
        &LandingPattern::board_size_m}) {
    LandingPattern pattern;
    pattern.*length = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(ViolationsOf(pattern).empty());
    pattern.*length = 0;
    EXPECT_FALSE(ViolationsOf(pattern).empty());
    pattern.*length = std::numeric_limits<double>::infinity();
    EXPECT_FALSE(ViolationsOf(pattern).empty());
  }
}

}  // namespace
}  // namespace kestrel
