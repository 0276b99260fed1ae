// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/landing_guidance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/options.h"
#include "kestrel/flight/guidance/test_flight_phases.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Phase = GuidancePhase;

TEST(LandingGuidanceTest, LandsOnTurningTargetInWind) {
  TestFlight flight;
  ASSERT_TRUE(flight.FlyUntil([&] { return flight.Height() <= 0; }, 30));
  EXPECT_EQ(flight.output.phase, Phase::kCommit);
  EXPECT_EQ(flight.guidance.go_arounds(), 0);
  const Vector3d slip = flight.uav.velocity() - flight.target.Velocity(flight.time_s);
  EXPECT_LT(flight.Off(), 0.25);
  EXPECT_LT(slip.head<2>().norm(), 0.5);
  EXPECT_NEAR(-slip.z(), 0.7, 0.2);
}

TEST(LandingGuidanceTest, GoesThroughPhasesInOrder) {
  TestFlight flight;
  std::vector<Phase> phases;
  flight.FlyUntil(
      [&] {
        if (phases.empty() || phases.back() != flight.output.phase) {
          phases.push_back(flight.output.phase);
        }
        return flight.Height() <= 0;
      },
      30,
      [&](GuidanceInput& input) {
        if (flight.time_s < 1) input.target.reset();
      });
  // The phase of following ends at once where all is well.
  EXPECT_THAT(phases, testing::ElementsAre(Phase::kIdle, Phase::kSearch, Phase::kApproach,
                                           Phase::kDescend, Phase::kCommit));
}

struct Autopilot {
  const char* name;
  TestUavOptions uav;
};

// Autopilots that differ in everything that guidance does not know.
TEST(LandingGuidanceTest, LandsWithDifferentAutopilots) {
  TestUavOptions stiff;
  stiff.compensates_drag = true;
  TestUavOptions slow = stiff;
  slow.attitude_lag_s = 0.12;
  TestUavOptions weak;
  weak.p = 2;
  TestUavOptions much_drag = TestUavOptions::Px4();
  much_drag.drag = 0.4;
  TestUavOptions late = TestUavOptions::Px4();
  late.delay_s = 0.1;
  TestUavOptions shaping = TestUavOptions::ArduCopter();
  shaping.shaping_accel = 9;
  shaping.shaping_jerk = 20;
  shaping.max_tilt_deg = 45;
  const Autopilot autopilots[] = {{"stiff", stiff},         {"slow", slow},
                                  {"weak", weak},           {"PX4", TestUavOptions::Px4()},
                                  {"much drag", much_drag}, {"late", late},
                                  {"ArduCopter", shaping}};
  for (const double speed_mps : {4.2, 8.33}) {
    VehicleMotionOptions vehicle;
    vehicle.speed_mps = speed_mps;
    if (speed_mps > 5) vehicle.radius_m = 26;
    GuidanceOptions options;
    options.limits.max_speed_mps = 16;
    options.limits.max_tilt_deg = 45;
    for (const Autopilot& autopilot : autopilots) {
      options.model.control = autopilot.uav.Control();
      SCOPED_TRACE(std::string(autopilot.name) + (speed_mps > 5 ? ", 30 km/h" : ", 15 km/h"));
      std::vector<double> off_m;
      for (int seed = 1; seed <= 10; ++seed) {
        TestFlight flight(options, autopilot.uav, vehicle, seed);
        flight.FlyUntil([&] { return flight.Height() <= 0; }, 60,
                        [&](GuidanceInput& input) { input.link_delay_s = autopilot.uav.delay_s; });
        off_m.push_back(flight.Height() <= 0 ? flight.Off() : 100);
      }
      std::sort(off_m.begin(), off_m.end());
      EXPECT_LT(off_m[5], speed_mps > 5 ? 0.35 : 0.25);
      EXPECT_LT(off_m[8], 0.5);
    }
  }
}

// A drag of 1 per s takes 4.2 m/s^2 from a UAV over a car at 15 km/h, which PX4's velocity control
// answers with 2.3 m/s.
TEST(LandingGuidanceTest, FollowsDespiteDragAndDelay) {
  for (const double delay_s : {0.0, 0.1}) {
    for (const double drag : {0.1, 0.35, 1.0}) {
      SCOPED_TRACE("drag " + std::to_string(drag) + ", delay " + std::to_string(delay_s));
      TestUavOptions uav = TestUavOptions::Px4();
      uav.drag = drag;
      uav.delay_s = delay_s;
      GuidanceOptions options;
      options.limits.max_tilt_deg = 45;
      options.model.control = uav.Control();
      std::vector<double> off_m;
      for (int seed = 1; seed <= 10; ++seed) {
        TestFlight flight(options, uav, {}, seed);
        flight.wind = [](double) { return Vector3d(0.5, -0.5, 0); };
        const bool is_down =
            flight.FlyUntil([&] { return flight.Height() <= 0; }, 15,
                            [&](GuidanceInput& input) { input.link_delay_s = delay_s; });
        EXPECT_TRUE(is_down) << seed;
        EXPECT_EQ(flight.guidance.go_arounds(), 0) << seed;
        off_m.push_back(flight.Off());
      }
      std::sort(off_m.begin(), off_m.end());
      EXPECT_LT(off_m[5], 0.2);
      EXPECT_LT(off_m[9], 0.35);
    }
  }
}

// Beginning and end.

TEST(LandingGuidanceTest, StartsOnlyWhenModeIsEntered) {
  TestFlight flight;
  for (int i = 0; i < 50; ++i) {
    flight.Step(kTakenBack);
    EXPECT_EQ(flight.output.phase, Phase::kIdle);
    EXPECT_FALSE(flight.output.set_point);
  }
  flight.Step();
  EXPECT_EQ(flight.output.phase, Phase::kApproach);
  EXPECT_TRUE(flight.output.set_point);
}

TEST(LandingGuidanceTest, DoesNotStartInModeEnteredBefore) {
  TestFlight flight;
  flight.time_s = 1;
  for (int i = 0; i < 20; ++i) EXPECT_FALSE(flight.Step().set_point);
  EXPECT_THAT(flight.output.reason, testing::HasSubstr("leave it"));
  flight.Step(kTakenBack);
  EXPECT_TRUE(flight.Step().set_point);
}

TEST(LandingGuidanceTest, StreamsOnlyBeforeFirstStartAndAfterRearm) {
  GuidanceOptions options;
  options.stream_before_start = true;
  TestFlight flight(options);
  flight.Step(kTakenBack);
  ASSERT_TRUE(flight.output.set_point);
  EXPECT_EQ(flight.output.set_point->velocity.norm(), 0);
  flight.FlyUntil([] { return false; }, 2);
  flight.guidance.Rearm();  // no effect in flight
  for (int i = 0; i < 20; ++i) EXPECT_FALSE(flight.Step(kTakenBack).set_point);
  flight.guidance.Rearm();
  EXPECT_TRUE(flight.Step(kTakenBack).set_point);
}

class TakenBackTest : public testing::TestWithParam<Phase> {};
TEST_P(TakenBackTest, SendsNothingUntilModeIsEnteredAgain) {
  GuidanceOptions options;
  options.stream_before_start = true;
  TestFlight flight = InPhase(GetParam(), options);
  ASSERT_TRUE(flight.output.set_point);
  for (int i = 0; i < 200; ++i) {
    flight.Step(kTakenBack);
    EXPECT_FALSE(flight.output.set_point);
    EXPECT_EQ(flight.output.request, GuidanceRequest::kNone);
  }
  EXPECT_EQ(flight.output.phase, GetParam() == Phase::kLanded ? Phase::kLanded : Phase::kIdle);
  flight.is_on_deck = false;
  EXPECT_TRUE(flight.Step().set_point);
}
INSTANTIATE_TEST_SUITE_P(InEachPhase, TakenBackTest,
                         testing::Values(Phase::kSearch, Phase::kApproach, Phase::kFollow,
                                         Phase::kDescend, Phase::kCommit, Phase::kGoAround,
                                         Phase::kLanded));

TEST(LandingGuidanceTest, RefusesUnflyableStart) {
  struct Refusal {
    const char* reason;
    void (*change)(GuidanceInput&);
    GuidanceRequest request;
  };
  const Refusal refusals[] = {
      {"on the ground", [](GuidanceInput& input) { input.is_armed = false; },
       GuidanceRequest::kNone},
      {"on the ground", [](GuidanceInput& input) { input.is_landed = true; },
       GuidanceRequest::kNone},
      {"not known", [](GuidanceInput& input) { input.uav.reset(); }, GuidanceRequest::kHold},
      {"geofence", [](GuidanceInput& input) { input.uav->world_from_body.translation.x() = 101; },
       GuidanceRequest::kHold},
      {"ceiling", [](GuidanceInput& input) { input.uav->world_from_body.translation.z() = 31; },
       GuidanceRequest::kHold}};
  for (const Refusal& refusal : refusals) {
    TestFlight flight;
    flight.guidance = LandingGuidance({}, Vector2d(0, 0));
    flight.Step();  // the mode is not yet given
    for (int i = 0; i < 5; ++i) {
      flight.Step(refusal.change);
      EXPECT_FALSE(flight.output.set_point);
      EXPECT_EQ(flight.output.request, refusal.request);
      EXPECT_THAT(flight.output.reason, testing::HasSubstr(refusal.reason));
    }
    EXPECT_FALSE(flight.Step().set_point) << "the mode has to be given anew";
    flight.Step(kTakenBack);
    EXPECT_TRUE(flight.Step().set_point);
  }
}

TEST(LandingGuidanceTest, EndsWhenMotorsAreOff) {
  TestFlight flight = InPhase(Phase::kDescend);
  flight.Step([](GuidanceInput& input) { input.is_armed = false; });
  EXPECT_FALSE(flight.output.set_point);
  EXPECT_EQ(flight.output.phase, Phase::kIdle);
}

// Search.

TEST(LandingGuidanceTest, WaitsAtExpectedPlaceOfVehicle) {
  TestFlight flight;
  flight.guidance = LandingGuidance({}, Vector2d(8, -5));
  flight.FlyUntil([] { return false; }, 12, kNoTarget);
  EXPECT_EQ(flight.output.phase, Phase::kSearch);
  EXPECT_LT((flight.Feet() - Vector3d(8, -5, 10)).norm(), 1);
}

TEST(LandingGuidanceTest, CirclesOutwardsAfterAWhile) {
  GuidanceOptions options;
  options.search_wait_s = 2;
  options.search_radius_m = 20;
  TestFlight flight(options);
  double furthest_m = 0;
  flight.FlyUntil(
      [&] {
        furthest_m = std::max(furthest_m, flight.Feet().head<2>().norm());
        return false;
      },
      60, kNoTarget);
  EXPECT_GT(furthest_m, 17);
  EXPECT_LT(furthest_m, 23);
}

// Limits.

TEST(LandingGuidanceTest, StaysWithinLimitsWhereverTargetGoes) {
  GuidanceOptions options;
  options.limits.geofence_radius_m = 25;
  VehicleMotionOptions vehicle;
  vehicle.path = "straight";
  TestFlight flight(options, {}, vehicle);
  double furthest_m = 0;
  flight.FlyUntil(
      [&] {
        furthest_m = std::max(furthest_m, flight.uav.position().head<2>().norm());
        if (!flight.output.set_point) return false;
        EXPECT_LE(flight.output.set_point->velocity.head<2>().norm(), 12 + 1e-9);
        EXPECT_LE(flight.output.set_point->acceleration.head<2>().norm(), 5.67);
        return false;
      },
      30,
      [&](GuidanceInput& input) {
        input.target = flight.target.Estimate(input.now, flight.time_s, 0.4);
      });
  EXPECT_LT(furthest_m, 25.5);
  EXPECT_GT(furthest_m, 20);
}

// Contact.

TEST(LandingGuidanceTest, KeepsDescendingWithDeckInContact) {
  TestFlight flight = InPhase(Phase::kLanded);
  const Vector3d deck = flight.target.Velocity(flight.time_s);
  ASSERT_TRUE(flight.output.set_point);
  EXPECT_LT((flight.output.set_point->velocity - deck).head<2>().norm(), 0.3);
  EXPECT_LT(flight.output.set_point->velocity.z(), -0.5);
  EXPECT_EQ(flight.output.request, GuidanceRequest::kNone);
  // The camera sees nothing any more.
  flight.FlyUntil([] { return false; }, 5, kNoTarget);
  EXPECT_EQ(flight.output.phase, Phase::kLanded);
  EXPECT_LT(flight.output.set_point->velocity.z(), -0.5);
  flight.Step([](GuidanceInput& input) { input.is_armed = false; });
  EXPECT_EQ(flight.output.phase, Phase::kLanded);
  EXPECT_FALSE(flight.output.set_point);
}

TEST(LandingGuidanceTest, RequestsLandOrDisarmOnlyByOptionAndInContact) {
  GuidanceOptions options;
  options.land_in_contact = true;
  options.disarm_after_s = 2;
  TestFlight flight(options);
  flight.FlyUntil(
      [&] {
        EXPECT_EQ(flight.output.request, GuidanceRequest::kNone);
        return flight.Height() <= 0;
      },
      30);
  flight.LandOnDeck();
  EXPECT_EQ(flight.output.request, GuidanceRequest::kNone) << "LAND brakes where a deck drives";
  flight.Step([](GuidanceInput& input) { input.is_landed = true; });
  EXPECT_EQ(flight.output.request, GuidanceRequest::kLand);
  flight.FlyUntil([] { return false; }, 2.1, kNoTarget);
  EXPECT_EQ(flight.output.request, GuidanceRequest::kDisarm);
  flight.Step([](GuidanceInput& input) { input.uav->world_from_body.translation.z() += 0.8; });
  EXPECT_EQ(flight.output.request, GuidanceRequest::kNone);
  EXPECT_EQ(flight.output.phase, Phase::kGoAround);
}

TEST(LandingGuidanceTest, RequestsLandOnceDeckHasStoppedForGood) {
  GuidanceOptions options;
  options.land_in_contact = true;
  VehicleMotionOptions vehicle;
  vehicle.path = "standing";
  TestFlight flight(options, {}, vehicle);
  flight.LandOnDeck();
  const auto isrequested = [&] { return flight.output.request == GuidanceRequest::kLand; };
  EXPECT_FALSE(flight.FlyUntil(isrequested, 4.5)) << "a car at a traffic light drives on";
  EXPECT_TRUE(flight.FlyUntil(isrequested, 2));
}

TEST(LandingGuidanceTest, DisarmsOnDeckThatCarriesItThroughCurves) {
  TestFlight flight;  // the figure of eight at 15 km/h
  flight.LandOnDeck();
  const bool is_disarmed = flight.FlyUntil(
      [&] { return flight.output.request == GuidanceRequest::kDisarm; }, 20, kNoTarget);
  EXPECT_TRUE(is_disarmed);
  EXPECT_EQ(flight.output.phase, Phase::kLanded);
}

TEST(LandingGuidanceTest, DoesNotForceDisarmOnStraightDrivingDeck) {
  VehicleMotionOptions vehicle;
  vehicle.path = "straight";
  TestFlight flight({}, {}, vehicle);
  flight.LandOnDeck();
  const bool is_disarmed = flight.FlyUntil(
      [&] { return flight.output.request == GuidanceRequest::kDisarm; }, 20, kNoTarget);
  EXPECT_FALSE(is_disarmed);
}

TEST(LandingGuidanceTest, AcceptsContactReportedByAutopilot) {
  TestFlight flight = InPhase(Phase::kCommit);
  flight.Step([](GuidanceInput& input) { input.is_landed = true; });
  EXPECT_EQ(flight.output.phase, Phase::kLanded);
}

TEST(GuidanceOptionsTest, LimitsSearchAndApproachToSightRange) {
  const GuidanceOptions options;
  const GuidanceOptions far = options.WithinSight(22);
  EXPECT_EQ(far.search_altitude_m, options.search_altitude_m);
  EXPECT_EQ(far.follow_height_m, options.follow_height_m);
  EXPECT_EQ(far.search_radius_m, 0);
  EXPECT_EQ(options.WithinSight(5).search_altitude_m, 4);
  EXPECT_EQ(options.WithinSight(5).search_radius_m, options.search_altitude_m - 4);
  EXPECT_EQ(options.WithinSight(5).follow_height_m, options.follow_height_m);
  // The floor stays: it may be above trees.
  const GuidanceOptions near = options.WithinSight(1.6);
  EXPECT_EQ(near.search_altitude_m, options.limits.floor_m);
  EXPECT_NEAR(near.follow_height_m, 0.8 * 1.6 - options.leg_m, 1e-12);
  EXPECT_THAT(ViolationsOf(options.WithinSight(1e-3)), testing::IsEmpty());
  GuidanceOptions without_floor;
  without_floor.limits.floor_m = 0;
  EXPECT_THAT(ViolationsOf(without_floor.WithinSight(1e-3)), testing::IsEmpty());
}

TEST(GuidanceOptionsTest, ReportsFaultyOptions) {
  GuidanceOptions options;
  options.leg_m = 3;
  options.limits.max_tilt_deg = 90;
  options.model.delay_s = 1;
  EXPECT_THAT(ViolationsOf(options),
              testing::ElementsAre("leg_m is 3, expected 0 to 2",
                                   "limits.max_tilt_deg is 90, expected 1 to 80",
                                   "model.delay_s is 1, expected 0 to 0.4"));
  options = {};
  options.search_altitude_m = 40;
  EXPECT_THAT(ViolationsOf(options),
              testing::ElementsAre("search_altitude_m is 40, expected 3 to 30"));
}

}  // namespace
}  // namespace kestrel
