// SPDX-License-Identifier: BSD-3-Clause
// Simulated autopilots fly to an object of a field and pick it, over MAVLink, in simulated time and
// without images. bench/go_accuracy.cc has more of them.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/simulation/autopilots/test_team_flight.h"

namespace kestrel {
namespace {

using testing::HasSubstr;

// A small field of three discs that stand and three that move.
GoFlightSetup SetupOf(AutopilotFirmware firmware, const std::string& class_name) {
  GoFlightSetup setup;
  setup.firmware = firmware;
  setup.class_name = class_name;
  setup.field = {"field.length_m=12",
                 "field.width_m=8",
                 "field.objects.red=3",
                 "field.objects.green=0",
                 "field.objects.blue=0",
                 "field.objects.yellow=3",
                 "field.objects.yellow_path=straight",
                 "field.objects.yellow_speed_mps=1.4",
                 "ground.map_px=256"};
  setup.model.pilot.guide_after_s = 5;
  setup.model.pilot.land_after_s = -1;
  setup.model.pilot.start_altitude_m = 6;
  setup.model.uav.wind = {.min_mps = 0, .max_mps = 0};
  setup.flight.guidance.search_altitude_m = 6;
  return setup;
}

class GoFlightTest : public testing::TestWithParam<AutopilotFirmware> {};
INSTANTIATE_TEST_SUITE_P(Both, GoFlightTest,
                         testing::Values(AutopilotFirmware::kArduPilot, AutopilotFirmware::kPx4));

TEST_P(GoFlightTest, PicksDiscThatStands) {
  SightedGoFlight flight(SetupOf(GetParam(), "red"));
  ASSERT_TRUE(flight.FlyUntilDone(120)) << flight.reported;
  const SitlResult& result = flight.model.result();
  ASSERT_TRUE(result.grab);
  EXPECT_TRUE(result.grab->is_taken);
  EXPECT_LT(result.grab->offset_m, 0.07);
  EXPECT_THAT(flight.reported, HasSubstr("done: the object is gone from the ground"));
}

TEST_P(GoFlightTest, PicksDiscThatMoves) {
  SightedGoFlight flight(SetupOf(GetParam(), "yellow"));
  ASSERT_TRUE(flight.FlyUntilDone(180)) << flight.reported;
  EXPECT_TRUE(flight.model.result().grab->is_taken);
}

TEST_P(GoFlightTest, GivesUpWithoutGripper) {
  GoFlightSetup setup = SetupOf(GetParam(), "red");
  setup.model.has_gripper = false;
  SightedGoFlight flight(setup);
  EXPECT_FALSE(flight.FlyUntilDone(60));
  EXPECT_THAT(flight.reported, HasSubstr("does not operate the gripper: gave up"));
}

// No object is seen there.
TEST_P(GoFlightTest, DropsAtPlace) {
  GoFlightSetup setup = SetupOf(GetParam(), "red");
  setup.place = Eigen::Vector2d(9, -14);
  setup.job = "drop,2.65";
  SightedGoFlight flight(setup);
  ASSERT_TRUE(flight.FlyUntilDone(120)) << flight.reported;
  const auto& released_at = flight.model.result().released_at;
  ASSERT_TRUE(released_at);
  EXPECT_LT((released_at->head<2>() - *setup.place).norm(), 0.5);
  EXPECT_NEAR(released_at->z(), 2.65, 0.2);
  EXPECT_THAT(flight.reported, HasSubstr("done: the gripper is open"));
}

TEST_P(GoFlightTest, RefusesPlaceOutsideOfGeofence) {
  GoFlightSetup setup = SetupOf(GetParam(), "red");
  setup.place = Eigen::Vector2d(90, -90);
  setup.job = "hover,3";
  SightedGoFlight flight(setup);
  flight.Fly(10);
  EXPECT_EQ(flight.phase(), GuidancePhase::kIdle);
  EXPECT_THAT(flight.reported, HasSubstr("the place is 127 m from home, limits.geofence_radius_m"));
}

TEST_P(GoFlightTest, PilotTakesTheUavBack) {
  GoFlightSetup setup = SetupOf(GetParam(), "red");
  setup.model.pilot.take_back_after_s = 12;
  SightedGoFlight flight(setup);
  flight.Fly(20);
  EXPECT_EQ(flight.phase(), GuidancePhase::kIdle);
  EXPECT_LT(flight.model.result().last_set_point_after_s, 0.2);
}

// Two UAVs, and a radio that loses messages.
TEST_P(GoFlightTest, TeamDeliversEachDiscOnce) {
  const Eigen::Vector2d box(0, -10);
  std::vector<GoFlightSetup> setups(2, SetupOf(GetParam(), "red"));
  for (std::size_t i = 0; i < setups.size(); ++i) {
    setups[i].box = box;
    setups[i].model.pilot.offset_east_m = i == 0 ? -6 : 6;
  }
  TeamGoFlights flights(setups);
  flights.radio().loss = 0.2;
  const auto delivered = [&] { return flights.CountDelivered(box, /*radius_m=*/0.7); };
  while (flights.seconds() < 300 && delivered() < 3) flights.Fly(1);
  EXPECT_EQ(delivered(), 3) << flights.uavs[0]->reported << flights.uavs[1]->reported;
  EXPECT_EQ(flights.CountTaken(), 3);
  EXPECT_GT(flights.nearest_m, 4);
}

}  // namespace
}  // namespace kestrel
