// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/flight/guidance/test_flight_phases.h"

namespace kestrel {
namespace {

using Phase = GuidancePhase;

// Below 2 m there is no descent without a target in sight, except for a moment in the last bit.
class UnseenTest : public testing::TestWithParam<double> {};
TEST_P(UnseenTest, DoesNotDescend) {
  TestFlight flight = InPhase(Phase::kDescend);
  ASSERT_TRUE(flight.FlyUntil([&] { return flight.Height() < GetParam(); }, 20));
  const Time last_seen = flight.Input().now;
  double lowest_m = flight.Height();
  const double began_m = lowest_m;
  flight.FlyUntil(
      [&] {
        lowest_m = std::min(lowest_m, flight.Height());
        const bool is_unseen = ToSeconds(flight.Input().now - last_seen) > 0.52;
        if (is_unseen) {
          EXPECT_GE(flight.output.set_point->velocity.z(), 0);
        }
        return false;
      },
      6,
      [&](GuidanceInput& input) {
        input.target_age_s = ToSeconds(input.now - last_seen);
        if (input.target_age_s > 3) input.target.reset();
      });
  EXPECT_GT(lowest_m, std::min(0.4 * began_m, began_m - 0.3));
  EXPECT_EQ(flight.guidance.go_arounds(), 1);
  EXPECT_GT(flight.Height(), 2.3);
}
INSTANTIATE_TEST_SUITE_P(FromHeights, UnseenTest, testing::Values(2.2, 1.8, 1.2, 0.8));

TEST(LandingGuidanceLossesTest, HoldsHeightAboveTwoMetresThenSearches) {
  TestFlight flight = InPhase(Phase::kDescend);
  ASSERT_TRUE(flight.FlyUntil([&] { return flight.Height() < 2.45; }, 20, kAsItIs));
  flight.FlyUntil([] { return false; }, 1, kUnseen);
  EXPECT_GT(flight.Height(), 2);
  flight.FlyUntil([] { return false; }, 12, kNoTarget);
  EXPECT_EQ(flight.output.phase, Phase::kSearch);
  EXPECT_NEAR(flight.Feet().z(), 10, 0.5);
}

TEST(LandingGuidanceLossesTest, CommitsOnlyWithFreshSight) {
  TestFlight flight = InPhase(Phase::kCommit);
  flight.Step([](GuidanceInput& input) { input.target_age_s = 0.9; });
  EXPECT_LT(flight.output.set_point->velocity.z(), -0.5);
  flight.Step([](GuidanceInput& input) { input.target_age_s = 1.1; });
  EXPECT_EQ(flight.output.phase, Phase::kGoAround);
  EXPECT_GT(flight.output.set_point->velocity.z(), 0.5);
}

TEST(LandingGuidanceLossesTest, DoesNotDescendOnUncertainTarget) {
  TestFlight flight;
  double sigma_m = 0.4;
  const auto is_bad = [&](GuidanceInput& input) {
    input.target = flight.target.Estimate(input.now, flight.time_s, sigma_m);
  };
  flight.FlyUntil([] { return false; }, 20, is_bad);
  EXPECT_EQ(flight.output.phase, Phase::kFollow);
  EXPECT_NEAR(flight.Height(), 2.5, 0.4) << "follows";
  sigma_m = 0.8;
  flight.FlyUntil([] { return false; }, 20, is_bad);
  EXPECT_NEAR(flight.Feet().z(), 10, 0.4) << "climbs";
}

// A frozen image has this effect: the target seems to sink as the UAV does.
TEST(LandingGuidanceLossesTest, DoesNotFollowTargetDownwards) {
  TestFlight flight = InPhase(Phase::kDescend);
  flight.Step([](GuidanceInput& input) { input.target->motion.mean(5) = -1.3; });
  EXPECT_EQ(flight.output.phase, Phase::kGoAround);
  EXPECT_THAT(flight.output.reason, testing::HasSubstr("not a deck"));
}

TEST(LandingGuidanceLossesTest, GoesAroundWhenTrackJumps) {
  TestFlight flight = InPhase(Phase::kDescend);
  ASSERT_TRUE(flight.FlyUntil([&] { return flight.Height() < 1; }, 20));
  flight.Step([](GuidanceInput& input) { input.target->motion.mean(0) += 3; });
  EXPECT_EQ(flight.output.phase, Phase::kGoAround);
  EXPECT_GT(flight.output.set_point->velocity.z(), 0.5);
}

TEST(LandingGuidanceLossesTest, DoesNotDescendWithCameraDown) {
  TestFlight flight = InPhase(Phase::kDescend);
  const auto camera_down = [](GuidanceInput& input) { input.is_camera_up = false; };
  flight.Step(camera_down);
  EXPECT_GE(flight.output.set_point->velocity.z(), 0);
  flight.FlyUntil([] { return false; }, 11, camera_down);
  EXPECT_FALSE(flight.output.set_point);
  EXPECT_EQ(flight.output.request, GuidanceRequest::kHold);
  EXPECT_FALSE(flight.Step().set_point) << "does not begin again by itself";
}

class PosesStopTest : public testing::TestWithParam<Phase> {};
TEST_P(PosesStopTest, StopsDescentThenGivesUp) {
  TestFlight flight = InPhase(GetParam());
  const auto no_pose = [](GuidanceInput& input) { input.uav.reset(); };
  double sent_s = 0;
  flight.FlyUntil(
      [&] {
        if (!flight.output.set_point) return false;
        sent_s += kTestStep_s;
        EXPECT_GE(flight.output.set_point->velocity.z(), 0);
        return false;
      },
      3, no_pose);
  EXPECT_NEAR(sent_s, 1, 0.1);
  EXPECT_EQ(flight.output.request, GuidanceRequest::kHold);
  EXPECT_FALSE(flight.Step().set_point) << "does not begin again by itself";
  EXPECT_EQ(flight.output.request, GuidanceRequest::kHold);
  flight.Step(kTakenBack);
  EXPECT_EQ(flight.output.request, GuidanceRequest::kNone);
  EXPECT_TRUE(flight.Step().set_point);
}
INSTANTIATE_TEST_SUITE_P(InEachPhase, PosesStopTest,
                         testing::Values(Phase::kSearch, Phase::kApproach, Phase::kFollow,
                                         Phase::kDescend, Phase::kCommit, Phase::kGoAround));

TEST(LandingGuidanceLossesTest, ShortLossOfPosesEndsDescent) {
  TestFlight flight = InPhase(Phase::kDescend);
  flight.FlyUntil([] { return false; }, 0.6, [](GuidanceInput& input) { input.uav.reset(); });
  flight.Step();
  EXPECT_EQ(flight.guidance.go_arounds(), 1);
}

class LinkGoneTest : public testing::TestWithParam<double> {};
TEST_P(LinkGoneTest, SendsNothingAndGoesAroundAfterLongLoss) {
  TestFlight flight = InPhase(Phase::kDescend);
  const auto gone = [](GuidanceInput& input) { input.is_link_up = false; };
  flight.FlyUntil(
      [&] {
        EXPECT_FALSE(flight.output.set_point);
        return false;
      },
      GetParam(), gone);
  const Time back = flight.Input().now;
  const auto mode_notreported = [&](GuidanceInput& input) {
    input.mode_age_s = 0.3 + ToSeconds(input.now - back);
  };
  if (GetParam() < 0.8) {
    EXPECT_TRUE(flight.Step(mode_notreported).set_point);
    EXPECT_EQ(flight.guidance.go_arounds(), 0);
    return;
  }
  for (int i = 0; i < 20; ++i) EXPECT_FALSE(flight.Step(mode_notreported).set_point);
  flight.Step();
  ASSERT_TRUE(flight.output.set_point);
  EXPECT_EQ(flight.guidance.go_arounds(), 1);
  EXPECT_GE(flight.output.set_point->velocity.z(), 0);
}
INSTANTIATE_TEST_SUITE_P(ForSeconds, LinkGoneTest, testing::Values(0.5, 2.0, 10.0));

TEST(LandingGuidanceLossesTest, ModeLeftDuringLinkLossEndsGuidance) {
  TestFlight flight = InPhase(Phase::kDescend);
  flight.FlyUntil([] { return false; }, 2, [](GuidanceInput& input) { input.is_link_up = false; });
  for (int i = 0; i < 50; ++i) EXPECT_FALSE(flight.Step(kTakenBack).set_point);
  EXPECT_EQ(flight.output.phase, Phase::kIdle);
}

TEST(LandingGuidanceLossesTest, GivesUpWhenAutopilotDoesNotObey) {
  TestFlight flight;
  flight.Step();
  const UavState hovering = flight.uav.State();
  flight.FlyUntil([] { return false; }, 10, [&](GuidanceInput& input) { input.uav = hovering; });
  EXPECT_FALSE(flight.output.set_point);
  EXPECT_EQ(flight.output.request, GuidanceRequest::kHold);
  EXPECT_THAT(flight.output.reason, testing::HasSubstr("does not obey"));
}

TEST(LandingGuidanceLossesTest, GivesUpTargetThatStaysLost) {
  TestFlight flight = InPhase(Phase::kFollow);
  const auto lost = [](GuidanceInput& input) { input.target.reset(); };
  flight.Step(lost);
  EXPECT_EQ(flight.output.phase, Phase::kSearch);
  EXPECT_THAT(flight.output.reason, testing::HasSubstr("the target is lost: flies"));
  flight.FlyUntil([] { return false; }, 59, lost);
  EXPECT_TRUE(flight.output.set_point);
  flight.FlyUntil([] { return false; }, 2, lost);
  EXPECT_FALSE(flight.output.set_point);
  EXPECT_EQ(flight.output.request, GuidanceRequest::kHold);
  EXPECT_THAT(flight.output.reason, testing::HasSubstr("not found again"));
}

TEST(LandingGuidanceLossesTest, ReportsTooFastTargetAndGivesUpByOption) {
  GuidanceOptions options;
  options.cannot_follow_s = 10;
  TestFlight flight(options, {}, {.path = "straight", .speed_mps = 14});
  ASSERT_TRUE(flight.FlyUntil([&] { return flight.output.cannot_follow; }, 5));
  EXPECT_THAT(flight.guidance.demand().InWords(), testing::HasSubstr("m/s, the limit is 10"));
  flight.FlyUntil([&] { return flight.output.request == GuidanceRequest::kHold; }, 15);
  EXPECT_THAT(flight.output.reason, testing::HasSubstr("cannot keep up"));
  TestFlight slow({}, {}, {.path = "figure8", .speed_mps = 4.2});
  slow.FlyUntil([&] { return slow.output.cannot_follow; }, 20);
  EXPECT_FALSE(slow.output.cannot_follow);
}

TEST(LandingGuidanceLossesTest, SendsNoNonFiniteValues) {
  TestFlight flight = InPhase(Phase::kDescend);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i < 100; ++i) {
    flight.Step([&](GuidanceInput& input) {
      if (i % 4 == 0) input.target->motion.mean(i % 7) = nan;
      if (i % 4 == 1) input.uav->velocity_in_world.x() = nan;
      if (i % 4 == 2) input.target_age_s = nan;
    });
    if (!flight.output.set_point) continue;
    EXPECT_TRUE(flight.output.set_point->velocity.allFinite());
    EXPECT_TRUE(flight.output.set_point->acceleration.allFinite());
  }
}

TEST(LandingGuidanceLossesTest, EndsLandingWhenPosesStopOnDeck) {
  TestFlight flight;
  flight.LandOnDeck();
  ASSERT_EQ(flight.output.phase, Phase::kLanded);
  std::vector<GuidanceRequest> requests;
  flight.FlyUntil(
      [&] {
        EXPECT_EQ(flight.output.phase, Phase::kLanded);
        EXPECT_LT(flight.output.set_point->velocity.z(), -0.3);
        const GuidanceRequest request = flight.output.request;
        if (requests.empty() || requests.back() != request) requests.push_back(request);
        return request == GuidanceRequest::kDisarm;
      },
      6, [](GuidanceInput& input) { input.uav.reset(); });
  EXPECT_THAT(requests, testing::ElementsAre(GuidanceRequest::kNone, GuidanceRequest::kLand,
                                             GuidanceRequest::kDisarm));
}

}  // namespace
}  // namespace kestrel
