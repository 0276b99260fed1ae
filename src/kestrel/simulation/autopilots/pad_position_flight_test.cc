// SPDX-License-Identifier: BSD-3-Clause
// Simulated autopilots without GNSS fly and land by their place over a pad that stands, over
// MAVLink, in simulated time and without images.
#include <algorithm>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/simulation/autopilots/test_pointed_flight.h"

namespace kestrel {
namespace {

using testing::HasSubstr;

class PadPositionFlightTest : public testing::TestWithParam<AutopilotFirmware> {
 protected:
  static bool is_px4() { return GetParam() == AutopilotFirmware::kPx4; }

  static AutopilotModelOptions Uav(double altitude_m, double guide_after_s) {
    AutopilotModelOptions options;
    options.estimate.has_gnss = false;
    options.parameters = is_px4() ? "EKF2_EV_CTRL=11" : "VISO_TYPE=1,EK3_SRC1_POSXY=6";
    options.pilot.start_altitude_m = altitude_m;
    options.pilot.offset_east_m = 0.5;
    options.pilot.offset_north_m = -0.3;
    options.pilot.land_after_s = -1;
    options.pilot.guide_after_s = guide_after_s;
    return options;
  }
  static PointedFlight Flight(const AutopilotModelOptions& options, std::uint64_t seed = 1) {
    return {GetParam(),
            options,
            TestVehicle("standing", 0),
            {.has_gimbal = false, .guides = true, .sends_pad_position = true, .seed = seed}};
  }
};
INSTANTIATE_TEST_SUITE_P(Both, PadPositionFlightTest,
                         testing::Values(AutopilotFirmware::kArduPilot, AutopilotFirmware::kPx4));

TEST_P(PadPositionFlightTest, LandsOnPadThatStands) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    PointedFlight flight = Flight(Uav(5, 10), seed);
    ASSERT_TRUE(flight.Land(90)) << seed << ": " << flight.reported;
    ASSERT_TRUE(flight.model.result().contact);
    const double offset_m = flight.model.result().contact->feet_in_pattern.head<2>().norm();
    RecordProperty("offset_m_" + std::to_string(seed), std::to_string(offset_m));
    EXPECT_LT(offset_m, 0.15) << seed << ": " << flight.reported;
  }
}

TEST_P(PadPositionFlightTest, ReportsParameterThatIsMissing) {
  AutopilotModelOptions options = Uav(5, 20);
  options.parameters.clear();
  PointedFlight flight = Flight(options);
  flight.Fly(15);
  EXPECT_THAT(flight.reported, HasSubstr(is_px4() ? "set EKF2_EV_CTRL" : "set VISO_TYPE"));
}

// The autopilot itself would go on for seconds, and drift.
TEST_P(PadPositionFlightTest, LandsWhereItIsWhenPadIsLost) {
  PointedFlight flight = Flight(Uav(4, 10));
  flight.Fly(12);
  ASSERT_TRUE(IsGuidedMode(is_px4() ? AutopilotKind::kPx4 : AutopilotKind::kArduPilot,
                           flight.model.custom_mode()))
      << flight.reported;
  const Eigen::Vector3d place = flight.model.truth().world_from_body.translation;
  flight.is_blind = true;
  flight.Fly(3);
  EXPECT_EQ(
      flight.model.custom_mode(),
      CustomModeOf(is_px4() ? AutopilotKind::kPx4 : AutopilotKind::kArduPilot, FlightMode::kLand))
      << flight.reported;
  EXPECT_TRUE(flight.Land(40)) << flight.reported;
  const Eigen::Vector3d moved = flight.model.truth().world_from_body.translation - place;
  EXPECT_LT(moved.head<2>().norm(), 1.5);
}

}  // namespace
}  // namespace kestrel
