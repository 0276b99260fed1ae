// SPDX-License-Identifier: BSD-3-Clause
// Simulated autopilots that have neither a position nor a velocity hover over pads, follow them and
// land on them, over MAVLink, in simulated time and without images. bench/no_position_accuracy.cc
// measures how well.
#include <algorithm>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/simulation/autopilots/test_no_position_flight.h"

namespace kestrel {
namespace {

using testing::Each;
using testing::HasSubstr;
using testing::Not;

class NoPositionFlightTest : public testing::TestWithParam<AutopilotFirmware> {
 protected:
  static bool is_px4() { return GetParam() == AutopilotFirmware::kPx4; }
  static AutopilotKind Kind() { return is_px4() ? AutopilotKind::kPx4 : AutopilotKind::kArduPilot; }
  static bool IsIn(const PointedFlight& flight, FlightMode mode) {
    return flight.model.custom_mode() == CustomModeOf(Kind(), mode);
  }
  // A ground station gives a mode.
  static mavlink::SetMode ModeOf(FlightMode flight_mode) {
    mavlink::SetMode mode;
    mode.target_system = 1;
    mode.base_mode = mavlink::kModeFlagCustom;
    mode.custom_mode = CustomModeOf(Kind(), flight_mode);
    return mode;
  }
  static NoPositionSetup Hover(double altitude_m, double wind_mps) {
    NoPositionSetup setup;
    setup.firmware = GetParam();
    setup.job.lands = false;
    setup.altitude_m = altitude_m;
    setup.wind_mps = wind_mps;
    return setup;
  }
  static NoPositionSetup Landing(double altitude_m = 4) {
    NoPositionSetup setup = Hover(altitude_m, 3);
    setup.job.lands = true;
    return setup;
  }
  static double HeightOf(const PointedFlight& flight) {
    return flight.model.truth().world_from_body.translation.z();
  }
  // Flies until it has hovered for some seconds.
  static void Settle(PointedFlight* flight) {
    flight->Fly(kNoPositionStart_s + 8);
    ASSERT_TRUE(IsIn(*flight, FlightMode::kGuidedByLean)) << flight->reported;
  }
};
INSTANTIATE_TEST_SUITE_P(Both, NoPositionFlightTest,
                         testing::Values(AutopilotFirmware::kArduPilot, AutopilotFirmware::kPx4));

TEST_P(NoPositionFlightTest, HoversInWindAtAnyHeight) {
  for (const double altitude_m : {1.0, 3.0, 6.0}) {
    PointedFlight flight = NoPositionFlightOf(Hover(altitude_m, 3));
    Settle(&flight);
    const HoverErrors errors = MeasureHover(&flight, 30, altitude_m);
    EXPECT_LT(errors.within_95, 0.09 + 0.015 * altitude_m) << altitude_m << "\n" << flight.reported;
    EXPECT_LT(errors.height_95, 0.2) << altitude_m;
    EXPECT_TRUE(IsIn(flight, FlightMode::kGuidedByLean)) << flight.reported;
  }
}

TEST_P(NoPositionFlightTest, LandsOnPadThatStands) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    NoPositionSetup setup = Landing();
    setup.seed = seed;
    PointedFlight flight = NoPositionFlightOf(setup);
    EXPECT_TRUE(flight.Land(60)) << flight.reported;
    ASSERT_TRUE(flight.model.result().contact) << flight.reported;
    EXPECT_TRUE(flight.model.result().contact->on_board);
    EXPECT_LT(flight.model.result().offset_m(), 0.15) << seed;
  }
}

TEST_P(NoPositionFlightTest, LandsOnPadThatDrives) {
  NoPositionSetup setup = Landing(3);
  setup.job.pad_moves = true;
  setup.pad_mps = 1;
  PointedFlight flight = NoPositionFlightOf(setup);
  EXPECT_TRUE(flight.Land(60)) << flight.reported;
  ASSERT_TRUE(flight.model.result().contact) << flight.reported;
  EXPECT_TRUE(flight.model.result().contact->on_board);
  EXPECT_LT(flight.model.result().offset_m(), 0.2);
}

// The compass over steel: a loop that used north would fly in circles.
TEST_P(NoPositionFlightTest, CompassThatTurnsDoesNotMoveIt) {
  NoPositionSetup setup = Hover(3, 3);
  setup.turn_after_s = kNoPositionStart_s + 10;
  PointedFlight flight = NoPositionFlightOf(setup);
  Settle(&flight);
  EXPECT_LT(MeasureHover(&flight, 20, 3).largest, 0.4) << flight.reported;
}

// An acceleration that lasts is taken for tilt by the autopilot.
TEST_P(NoPositionFlightTest, FollowsPadThatAcceleratesForSeconds) {
  NoPositionSetup setup = Hover(3, 0);
  setup.job.pad_moves = true;
  setup.pad_mps = 7.5;
  setup.drive_after_s = kNoPositionStart_s + 10;
  setup.drive_acceleration = 1.5;
  PointedFlight flight = NoPositionFlightOf(setup);
  flight.Fly(kNoPositionStart_s + 9);
  EXPECT_LT(MeasureHover(&flight, 8, 3).within_95, 0.6) << flight.reported;
  EXPECT_TRUE(IsIn(flight, FlightMode::kGuidedByLean)) << flight.reported;
}

TEST_P(NoPositionFlightTest, WrongHoverThrustKeepsHeight) {
  for (const double error : {-0.2, 0.2}) {
    NoPositionSetup setup = Hover(3, 0);
    setup.hover_thrust_error = error;
    PointedFlight flight = NoPositionFlightOf(setup);
    flight.Fly(kNoPositionStart_s + 0.1);
    const HoverErrors errors = MeasureHover(&flight, 20, 3);
    EXPECT_LT(errors.height_95, 0.3) << error;
    EXPECT_LT(errors.fastest_sink_mps, 0.5) << error;
  }
}

TEST_P(NoPositionFlightTest, GoesOnAfterPadWasLostForASecond) {
  PointedFlight flight = NoPositionFlightOf(Hover(3, 3));
  Settle(&flight);
  flight.is_blind = true;
  flight.Fly(1);
  EXPECT_THAT(flight.reported, HasSubstr("the pad is lost: level"));
  flight.is_blind = false;
  flight.Fly(8);
  EXPECT_TRUE(IsIn(flight, FlightMode::kGuidedByLean)) << flight.reported;
  const HoverErrors errors = MeasureHover(&flight, 10, 3);
  EXPECT_LT(errors.within_95, 0.15) << flight.reported;
  EXPECT_LT(errors.height_95, 0.2) << flight.reported;
}

TEST_P(NoPositionFlightTest, ClimbsAndLandsWhenPadIsLostForGood) {
  PointedFlight flight = NoPositionFlightOf(Hover(3, 3));
  Settle(&flight);
  const Eigen::Vector3d place = flight.model.truth().world_from_body.translation;
  flight.is_blind = true;
  flight.Fly(2.5);
  EXPECT_THAT(flight.reported, HasSubstr("climbs to widen the view"));
  const auto moved_m = [&] {
    return (flight.model.truth().world_from_body.translation - place).head<2>().norm();
  };
  EXPECT_LT(moved_m(), 1);
  EXPECT_TRUE(flight.Land(40)) << flight.reported;
  EXPECT_THAT(flight.reported, HasSubstr("the pad is lost: lands where it is"));
  EXPECT_TRUE(IsIn(flight, FlightMode::kLand)) << flight.reported;
  EXPECT_LT(moved_m(), 4);
}

// PX4 reports a failsafe then: no reason to give another mode.
TEST_P(NoPositionFlightTest, LandThatKestrelRequestsGetsNoAdvice) {
  PointedFlight flight = NoPositionFlightOf(Hover(3, 0));
  Settle(&flight);
  flight.is_blind = true;
  EXPECT_TRUE(flight.Land(60)) << flight.reported;
  EXPECT_THAT(flight.reported, Not(HasSubstr("guidance would be refused"))) << flight.reported;
}

TEST_P(NoPositionFlightTest, WaitForLandedStateIsReported) {
  PointedFlight flight = NoPositionFlightOf(Hover(3, 0));
  flight.hides_landed_state = true;
  flight.Fly(kNoPositionStart_s + 6);
  EXPECT_THAT(flight.reported, HasSubstr("does not report whether it is in the air"));
}

TEST_P(NoPositionFlightTest, VelocityByFlowKeepsItWhereItLostPad) {
  NoPositionSetup setup = Hover(3, 3);
  setup.has_flow = true;
  PointedFlight flight = NoPositionFlightOf(setup);
  Settle(&flight);
  const Eigen::Vector3d place = flight.model.truth().world_from_body.translation;
  flight.is_blind = true;
  EXPECT_TRUE(flight.Land(40)) << flight.reported;
  EXPECT_LT((flight.model.truth().world_from_body.translation - place).head<2>().norm(), 0.5);
}

// Also where only the last metres show which of the pad's four headings it is.
TEST_P(NoPositionFlightTest, LandsWithTheHeadingThatIsWanted) {
  for (const double quarters_beyond_m : {100.0, 1.5}) {
    NoPositionSetup setup = Landing(3);
    setup.touchdown_heading = "30";
    setup.quarters_beyond_m = quarters_beyond_m;
    PointedFlight flight = NoPositionFlightOf(setup);
    EXPECT_TRUE(flight.Land(60)) << flight.reported;
    ASSERT_TRUE(flight.model.result().contact) << flight.reported;
    EXPECT_TRUE(flight.model.result().contact->on_board);
    const double heading = flight.model.result().contact->heading_in_pattern;
    EXPECT_NEAR(Degrees(std::remainder(heading - Radians(30), kFullTurn)), 0, 3) << flight.reported;
  }
}

TEST_P(NoPositionFlightTest, LandsByPadAloneWhenGnssIsLostInDescent) {
  for (const double lost_after_s : {kNoPositionStart_s + 0.5, kNoPositionStart_s + 1.5}) {
    NoPositionSetup setup = Landing(5);
    setup.gnss_lost_after_s = lost_after_s;
    PointedFlight flight = NoPositionFlightOf(setup);
    EXPECT_TRUE(flight.Land(60)) << flight.reported;
    EXPECT_THAT(flight.reported, HasSubstr("the position is lost: lands by the pad alone"));
    ASSERT_TRUE(flight.model.result().contact) << flight.reported;
    EXPECT_TRUE(flight.model.result().contact->on_board) << flight.reported;
    EXPECT_LT(flight.model.result().offset_m(), 0.2) << flight.reported;
  }
}

TEST_P(NoPositionFlightTest, DoesNotClimbBelowCeiling) {
  NoPositionSetup setup = Hover(3, 0);
  setup.job.has_ceiling = true;
  PointedFlight flight = NoPositionFlightOf(setup);
  Settle(&flight);
  flight.is_blind = true;
  flight.Fly(2.9);
  EXPECT_LT(HeightOf(flight), 3.3);
  EXPECT_THAT(flight.reported, Not(HasSubstr("climbs")));
}

TEST_P(NoPositionFlightTest, GivesUavToPilotWithSticksWhenPadIsLost) {
  NoPositionSetup setup = Hover(3, 0);
  setup.has_sticks = true;
  PointedFlight flight = NoPositionFlightOf(setup);
  Settle(&flight);
  flight.is_blind = true;
  flight.Fly(6);
  EXPECT_TRUE(IsIn(flight, FlightMode::kAltitude)) << flight.reported;
}

TEST_P(NoPositionFlightTest, OtherPadBesideDoesNotMakeItLeanFar) {
  PointedFlight flight = NoPositionFlightOf(Hover(3, 0));
  Settle(&flight);
  flight.pad_offset = {1.5, 0, 0};
  double lean = 0;
  for (int i = 0; i < 100; ++i) {
    flight.Fly(0.05);
    const Eigen::Vector3d up =
        flight.model.truth().world_from_body.rotation * Eigen::Vector3d::UnitZ();
    lean = std::max(lean, std::acos(std::min(up.z(), 1.0)));
  }
  EXPECT_LT(Degrees(lean), 11) << flight.reported;
}

TEST_P(NoPositionFlightTest, LandsWhenNoAttitudeIsSent) {
  NoPositionSetup setup = Hover(3, 3);
  setup.silent_after_s = kNoPositionStart_s + 8;
  PointedFlight flight = NoPositionFlightOf(setup);
  flight.Fly(setup.silent_after_s + 1.5);
  EXPECT_THAT(flight.reported, HasSubstr("the attitude is not sent: lands where it is"));
  EXPECT_TRUE(IsIn(flight, FlightMode::kLand)) << flight.reported;
}

// Kestrel does not take back what the pilot has left.
TEST_P(NoPositionFlightTest, PilotEndsLandingWithoutPosition) {
  NoPositionSetup setup = Landing(5);
  setup.gnss_lost_after_s = kNoPositionStart_s + 0.5;
  PointedFlight flight = NoPositionFlightOf(setup);
  flight.Fly(kNoPositionStart_s + 2.5);
  ASSERT_THAT(flight.reported, HasSubstr("lands by the pad alone"));
  flight.SendFromGround(ModeOf(FlightMode::kAltitude));
  flight.Fly(4);
  EXPECT_TRUE(IsIn(flight, FlightMode::kAltitude)) << flight.reported;
}

TEST_P(NoPositionFlightTest, GuardLandsWhenKestrelIsKilled) {
  PointedFlight flight = NoPositionFlightOf(Hover(2, 3));
  Settle(&flight);
  flight.Kill();
  flight.Fly(0.3);
  EXPECT_TRUE(IsIn(flight, FlightMode::kLand)) << flight.reported;
  EXPECT_THAT(flight.modes_by_guard(), Each(FlightMode::kLand));
  EXPECT_EQ(flight.refusals, 0);
  EXPECT_TRUE(flight.Land(30)) << flight.reported;
}

TEST_P(NoPositionFlightTest, RefusesAndLandsWhenPadWasNotSeen) {
  NoPositionSetup setup = Hover(3, 0);
  PointedFlight flight = NoPositionFlightOf(setup);
  flight.is_blind = true;
  flight.Fly(kNoPositionStart_s + 3);
  EXPECT_THAT(flight.reported, HasSubstr("refused: the pad is not in view"));
  EXPECT_TRUE(IsIn(flight, FlightMode::kLand)) << flight.reported;
}

// In GUIDED_NOGPS without set-points the UAV would drift, and the sticks are dead.
TEST(ArduPilotWithoutPositionTest, RefusesThrustThatIsNoClimbRateAndLands) {
  NoPositionSetup setup;
  setup.firmware = AutopilotFirmware::kArduPilot;
  setup.altitude_m = 3;
  setup.parameters = "GUID_OPTIONS=8";
  PointedFlight flight = NoPositionFlightOf(setup);
  flight.Fly(kNoPositionStart_s + 2);
  EXPECT_THAT(flight.reported, HasSubstr("GUID_OPTIONS has bit 3"));
  EXPECT_TRUE(flight.model.custom_mode() ==
              CustomModeOf(AutopilotKind::kArduPilot, FlightMode::kLand))
      << flight.reported;
}

}  // namespace
}  // namespace kestrel
