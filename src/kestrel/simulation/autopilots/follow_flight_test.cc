// SPDX-License-Identifier: BSD-3-Clause
// Simulated autopilots fly beside what a person has marked, over MAVLink, in simulated time and
// without images. bench/follow_flight_accuracy.cc has more of them.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/simulation/autopilots/test_followed_flight.h"

namespace kestrel {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr double kDistance_m = 10, kHeight_m = 7;
constexpr double kDown_deg = 35;  // how far below the horizon a fixed camera looks

FlightOptions FollowFrom(const std::string& side) {
  FlightOptions options;
  options.guidance.follow = {.distance_m = kDistance_m, .height_m = kHeight_m, .side = side};
  return options;
}

AutopilotModelOptions FollowingPilot(bool has_gimbal) {
  AutopilotModelOptions options;
  options.pilot.guide_after_s = 4;
  options.pilot.land_after_s = -1;
  options.pilot.offset_east_m = 9;
  options.pilot.offset_north_m = -7;
  options.pilot.heading_deg = -52;  // towards the vehicle
  options.has_gimbal = has_gimbal;
  return options;
}

class FollowFlightTest : public testing::TestWithParam<AutopilotFirmware> {};
INSTANTIATE_TEST_SUITE_P(Both, FollowFlightTest,
                         testing::Values(AutopilotFirmware::kArduPilot, AutopilotFirmware::kPx4));

TEST_P(FollowFlightTest, KeepsDistanceFromWalkerWithEitherCamera) {
  for (const bool has_gimbal : {false, true}) {
    FollowedFlight flight(GetParam(), FollowingPilot(has_gimbal), TestVehicle("stops", 1.4),
                          FollowFrom("free"), has_gimbal ? std::nullopt : std::optional(kDown_deg),
                          1);
    ASSERT_TRUE(flight.FollowWithin(40)) << flight.reported;
    flight.Fly(5);
    const FollowedFlight::Result result = flight.FlyAndMeasure(40);
    EXPECT_GT(result.share, 0.95) << has_gimbal;
    EXPECT_GT(result.seen_share, 0.99) << has_gimbal;
    EXPECT_GT(result.lowest_m, kHeight_m - 1) << has_gimbal;
    const bool points =
        flight.reported.find("points the gimbal at what is marked") != std::string::npos;
    EXPECT_EQ(points, has_gimbal) << flight.reported;
  }
}

TEST_P(FollowFlightTest, DoesNotMoveWithoutConfirmation) {
  FollowedFlight flight(GetParam(), FollowingPilot(false), TestVehicle("standing", 0),
                        FollowFrom("free"), kDown_deg, 1);
  flight.Fly(6);
  ASSERT_EQ(flight.phase(), GuidancePhase::kLook) << flight.reported;
  const Eigen::Vector3d began = flight.model.truth().world_from_body.translation;
  flight.Fly(20);
  EXPECT_EQ(flight.phase(), GuidancePhase::kLook);
  EXPECT_LT((flight.model.truth().world_from_body.translation - began).norm(), 1);
  EXPECT_THAT(flight.reported, Not(HasSubstr("approach")));
}

// Not before it is confirmed, and not after a stop.
TEST_P(FollowFlightTest, HoversAboveWalkerThatIsMarked) {
  GoJob job = ParseGoJob("hover,3,4");
  job.target = GoTarget::kMarked;
  FlightOptions options;
  options.guidance.search_altitude_m = 8;
  FollowedFlight flight(GetParam(), FollowingPilot(true), TestVehicle("standing", 0), options,
                        std::nullopt, 1, job);
  flight.Fly(8);
  ASSERT_EQ(flight.phase(), GuidancePhase::kLook) << flight.reported;
  EXPECT_THAT(flight.reported, Not(HasSubstr("approach")));
  flight.Confirm();
  flight.Fly(2);
  EXPECT_EQ(flight.phase(), GuidancePhase::kApproach) << flight.reported;
  flight.Stop();
  flight.Fly(4);
  EXPECT_EQ(flight.phase(), GuidancePhase::kLook);
  flight.Confirm();
  flight.Fly(60);
  EXPECT_THAT(flight.reported, HasSubstr("done: has hovered above the goal"));
}

}  // namespace
}  // namespace kestrel
