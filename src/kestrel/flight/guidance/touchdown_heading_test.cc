// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/touchdown_heading.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/options.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/flight/guidance/guidance_options.h"
#include "kestrel/flight/guidance/test_flight.h"

namespace kestrel {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

GuidanceOptions To(const char* heading) {
  GuidanceOptions options;
  options.touchdown_heading = heading;
  return options;
}

TargetEstimate Pad(double yaw, double period, double turn_rate = 0) {
  TargetEstimate target;
  target.motion.mean(TurnState::kYaw) = yaw;
  target.motion.mean(TurnState::kTurnRate) = turn_rate;
  target.motion.covariance(TurnState::kYaw, TurnState::kYaw) = 1e-4;
  target.yaw_period = period;
  return target;
}

// A nose that follows its commands at once, over a pad that turns at a rate.
struct Nose {
  double yaw = 0;
  double time_s = 0;
  double fastest = 0;

  void Turn(TouchdownHeading* heading, TargetEstimate pad, double seconds) {
    const double begin = pad.motion.yaw();
    for (const double end_s = time_s + seconds; time_s < end_s; time_s += kTestStep_s) {
      pad.motion.mean(TurnState::kYaw) = begin + time_s * pad.motion.turn_rate();
      heading->Update(TimeFromNanoseconds(0) + DurationFromSeconds(time_s), yaw, pad, 0);
      fastest = std::max(fastest, std::abs(std::remainder(heading->yaw() - yaw, kFullTurn)));
      yaw = heading->yaw();
    }
  }
};

TEST(TouchdownHeadingTest, TurnsToNearestEquivalentHeading) {
  struct Case {
    double period, wanted_deg, expected_deg;
  };
  for (const auto& [period, wanted_deg, expected_deg] :
       {Case{kFullTurn, 130, -170}, Case{kFullTurn / 2, 130, 10}, Case{kFullTurn / 4, 130, 10},
        Case{kFullTurn / 4, -40, 20}}) {
    TouchdownHeading heading(To(std::to_string(wanted_deg).c_str()));
    Nose nose;
    heading.Start(nose.yaw);
    nose.Turn(&heading, Pad(Radians(60), period), 8);
    EXPECT_NEAR(Degrees(std::remainder(nose.yaw, kFullTurn)), expected_deg, 0.5) << wanted_deg;
    EXPECT_TRUE(heading.is_reached());
    EXPECT_NEAR(*heading.error(), std::remainder(nose.yaw - Radians(60 + wanted_deg), period),
                1e-3);
    EXPECT_LE(nose.fastest, Radians(30) * kTestStep_s + 1e-9) << "no jump";
  }
}

TEST(TouchdownHeadingTest, TurnsWithPad) {
  TouchdownHeading heading(To("90"));
  Nose nose;
  heading.Start(nose.yaw);
  nose.Turn(&heading, Pad(1, kFullTurn, /*turn_rate=*/0.3), 8);
  EXPECT_TRUE(heading.is_reached());
  EXPECT_NEAR(heading.yaw_rate(), 0.3, 0.01);
}

TEST(TouchdownHeadingTest, DoesNotTurnToUnknownHeading) {
  TouchdownHeading heading(To("90"));
  Nose nose;
  heading.Start(nose.yaw);
  nose.Turn(&heading, Pad(1, /*period=*/0), 2);
  EXPECT_EQ(nose.yaw, 0);
  EXPECT_FALSE(heading.is_known());
  EXPECT_FALSE(heading.is_reached());
  TargetEstimate vague = Pad(1, kFullTurn);
  vague.motion.covariance(TurnState::kYaw, TurnState::kYaw) = 0.1;
  nose.Turn(&heading, vague, 2);
  EXPECT_FALSE(heading.is_known());
}

TEST(TouchdownHeadingTest, OptionsAreDegreesOrAny) {
  EXPECT_THAT(ViolationsOf(To("any")), IsEmpty());
  EXPECT_THAT(ViolationsOf(To("-90")), IsEmpty());
  EXPECT_NEAR(*To("-90").HeadingOverPad(), -kPi / 2, 1e-12);
  EXPECT_THAT(ViolationsOf(To("north")), ElementsAre(HasSubstr("touchdown_heading is 'north'")));
  EXPECT_THAT(ViolationsOf(To("400")), ElementsAre(HasSubstr("expected degrees from -360 to 360")));
}

// Turns a pad of TestFlight, whose UAV has always the heading 0.
struct Turned {
  double yaw = 0;
  double period = kFullTurn;
  void operator()(GuidanceInput& input) const {
    input.target->motion.mean(TurnState::kYaw) = yaw;
    input.target->yaw_period = period;
  }
};

TEST(TouchdownHeadingTest, WaitsAboveCommitHeightForHeadingThenGivesUp) {
  GuidanceOptions options = To("0");
  options.heading_wait_s = 8;
  TestFlight flight(options);
  double lowest_m = 10;
  const bool gave_up = flight.FlyUntil(
      [&] {
        lowest_m = std::min(lowest_m, flight.Height());
        return flight.guidance.has_given_up();
      },
      60, Turned{.yaw = 1});
  EXPECT_TRUE(gave_up);
  EXPECT_GT(lowest_m, options.commit_height_m);
  EXPECT_LT(lowest_m, 1.2) << "it waits low";
  EXPECT_THAT(flight.output.reason, HasSubstr("does not come to the heading"));
  EXPECT_EQ(flight.output.request, GuidanceRequest::kHold);
}

TEST(TouchdownHeadingTest, WaitsAtFollowHeightWithoutHeadingThenGivesUp) {
  TestFlight flight(To("0"));
  double lowest_m = 10;
  std::string reported;
  const bool gave_up = flight.FlyUntil(
      [&] {
        lowest_m = std::min(lowest_m, flight.Height());
        if (flight.output.phase == GuidancePhase::kFollow) reported = flight.output.reason;
        return flight.guidance.has_given_up();
      },
      60, Turned{.period = 0});
  EXPECT_TRUE(gave_up);
  EXPECT_GT(lowest_m, 2);
  EXPECT_THAT(reported, HasSubstr("the pad's heading is not known"));
  EXPECT_THAT(flight.output.reason, HasSubstr("is not known: gave up"));
}

TEST(TouchdownHeadingTest, LandsOnceHeadingIsReached) {
  TestFlight flight(To("0"));
  ASSERT_TRUE(flight.FlyUntil([&] { return flight.Height() <= 0; }, 40, Turned{}));
  EXPECT_EQ(flight.output.phase, GuidancePhase::kCommit);
  EXPECT_TRUE(flight.output.set_point->yaw_rate);
}

}  // namespace
}  // namespace kestrel
