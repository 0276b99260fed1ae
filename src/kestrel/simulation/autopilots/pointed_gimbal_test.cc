// SPDX-License-Identifier: BSD-3-Clause
// The gimbal of a simulated autopilot is pointed over MAVLink, in simulated time and without
// images.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/simulation/autopilots/test_pointed_flight.h"

namespace kestrel {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;
using testing::Not;

// A car that drives in a circle of 15 m around the origin.
VehicleWorldOptions CirclingCar() { return TestVehicle("circle", 4.2); }

// A UAV that hovers at a place, m from the origin.
AutopilotModelOptions HoverAt(const VehicleWorldOptions& vehicle, const Eigen::Vector2d& place,
                              const SimulatedMountOptions& gimbal) {
  const Vector3d start = TestWorld(vehicle).PatternAt(kTestStart).translation;
  AutopilotModelOptions options;
  options.has_gimbal = true;
  options.gimbal = gimbal;
  options.pilot.offset_east_m = place.x() - start.x();
  options.pilot.offset_north_m = place.y() - start.y();
  options.pilot.land_after_s = -1;
  options.pilot.follows_vehicle = false;
  return options;
}

class PointedGimbalTest : public testing::TestWithParam<AutopilotFirmware> {};
INSTANTIATE_TEST_SUITE_P(Both, PointedGimbalTest,
                         testing::Values(AutopilotFirmware::kArduPilot, AutopilotFirmware::kPx4));

// The direction of the car turns by 16 deg/s.
TEST_P(PointedGimbalTest, FollowsCarWithLateGimbalAndRareReports) {
  for (const double lag_s : {0.1, 0.15}) {
    for (const double reports_hz : {5.0, 20.0}) {
      SimulatedMountOptions gimbal;
      gimbal.lag_s = lag_s;
      gimbal.reports_hz = reports_hz;
      PointedFlight flight(GetParam(), HoverAt(CirclingCar(), {0, 0}, gimbal), CirclingCar());
      ASSERT_TRUE(flight.FlyUntilFound(40));
      flight.Fly(4);
      const PointingErrors errors = flight.FlyAndMeasure(40);
      const std::string name =
          "lag_" + std::to_string(lag_s) + "_reports_" + std::to_string(reports_hz);
      RecordProperty(name + "_rms_deg", std::to_string(errors.rms));
      RecordProperty(name + "_largest_deg", std::to_string(errors.largest));
      EXPECT_LT(errors.rms, 1) << name;
      EXPECT_LT(errors.largest, 2) << name;
      EXPECT_EQ(flight.reported, "points the gimbal at the pattern\n");
    }
  }
}

TEST_P(PointedGimbalTest, FindsTargetOutsideOfFirstViews) {
  const VehicleWorldOptions standing = TestVehicle("standing", 0);
  PointedFlight flight(GetParam(), HoverAt(standing, {12, -9}, {}), standing);
  flight.Fly(3);
  EXPECT_FALSE(flight.has_track()) << "straight down";
  ASSERT_TRUE(flight.FlyUntilFound(40));
  flight.Fly(3);
  EXPECT_LT(flight.FlyAndMeasure(1).largest, 1);
}

TEST_P(PointedGimbalTest, LeavesGimbalToStickUntilControlIsHandedBack) {
  SimulatedMountOptions gimbal;
  gimbal.stick_after_s = 10;
  PointedFlight flight(GetParam(), HoverAt(CirclingCar(), {0, 0}, gimbal), CirclingCar());
  flight.Fly(9.9);
  EXPECT_THAT(flight.reported, Not(HasSubstr("moves the gimbal")));
  flight.Fly(0.6);
  EXPECT_THAT(flight.reported, HasSubstr("the pilot's stick moves the gimbal"));
  flight.set_points = 0;
  flight.Fly(15);
  EXPECT_EQ(flight.set_points, 0);
  flight.GiveControl(255, 190);
  flight.Fly(1);
  EXPECT_EQ(flight.set_points, 0);
  flight.GiveControl(1, 191);
  flight.Fly(5);
  EXPECT_GT(flight.set_points, 60);
  EXPECT_TRUE(flight.FlyUntilFound(40));
}

TEST_P(PointedGimbalTest, LeavesGimbalToGroundStationInControl) {
  SimulatedMountOptions gimbal;
  gimbal.other_after_s = 10;
  PointedFlight flight(GetParam(), HoverAt(CirclingCar(), {0, 0}, gimbal), CirclingCar());
  flight.Fly(10.5);
  EXPECT_THAT(flight.reported, HasSubstr("system 255 component 190 moves the gimbal"));
  flight.set_points = 0;
  flight.Fly(10);
  EXPECT_EQ(flight.set_points, 0);
  flight.ResumePointing();
  flight.Fly(5);
  EXPECT_GT(flight.set_points, 60);
}

// ArduPilot obeys whoever sends last: two of them would share the gimbal.
TEST(PointedArduPilotGimbalTest, LeavesGimbalToSliderThatTakesNoControl) {
  PointedFlight flight(AutopilotFirmware::kArduPilot, HoverAt(CirclingCar(), {0, 0}, {}),
                       CirclingCar());
  flight.Fly(5);
  mavlink::GimbalManagerSetPitchyaw slider;  // level, ahead
  slider.pitch_rate = slider.yaw_rate = std::numeric_limits<float>::quiet_NaN();
  for (int i = 0; i < 750; ++i) {
    flight.SendFromGround(slider);
    flight.Fly(0.02);
  }
  EXPECT_THAT(flight.reported, HasSubstr("somebody else"));
}

TEST_P(PointedGimbalTest, ReportsAutopilotWithoutGimbal) {
  AutopilotModelOptions options = HoverAt(CirclingCar(), {0, 0}, {});
  options.has_gimbal = false;
  PointedFlight flight(GetParam(), options, CirclingCar());
  flight.Fly(10);
  EXPECT_THAT(flight.reported, HasSubstr("gives no control of the gimbal"));
  EXPECT_EQ(flight.set_points, 0);
}

struct Landings {
  int landed = 0;
  std::vector<double> offsets_m;

  double median_m() const {
    std::vector<double> sorted = offsets_m;
    std::sort(sorted.begin(), sorted.end());
    return sorted.empty() ? 99 : sorted[sorted.size() / 2];
  }
  double largest_m() const {
    return offsets_m.empty() ? 99 : *std::max_element(offsets_m.begin(), offsets_m.end());
  }
};

// Guided landings on the car on the figure of eight, each from another place of it and in another
// wind.
Landings LandOnCar(AutopilotFirmware firmware, bool has_gimbal,
                   const SimulatedMountOptions& gimbal) {
  constexpr int kFlights = 20;
  Landings landings;
  for (int seed = 1; seed <= kFlights; ++seed) {
    AutopilotModelOptions options;
    options.pilot.guide_after_s = 4 + 0.9 * seed;
    options.pilot.land_after_s = -1;
    if (firmware == AutopilotFirmware::kPx4) options.parameters = "LNDMC_XY_VEL_MAX=12";
    options.has_gimbal = has_gimbal;
    options.gimbal = gimbal;
    PointedFlight::Choice choice;
    choice.has_gimbal = has_gimbal;
    choice.half_view_deg = 40;
    choice.guides = true;
    choice.seed = static_cast<std::uint64_t>(seed);
    PointedFlight flight(firmware, options, TestVehicle("figure8", 4.2), choice);
    const bool is_down = flight.Land(120);
    const SitlResult& result = flight.model.result();
    if (!is_down || !result.contact || !result.contact->on_board) {
      ADD_FAILURE() << "seed " << seed << "\n" << flight.reported;
      continue;
    }
    ++landings.landed;
    landings.offsets_m.push_back(result.offset_m());
  }
  return landings;
}

// Not farther from the centre than with a camera that is fixed and looks down.
TEST_P(PointedGimbalTest, LandsOnCarAsWithFixedCamera) {
  const Landings fixed = LandOnCar(GetParam(), false, {});
  SimulatedMountOptions slow;
  slow.lag_s = 0.15;
  slow.reports_hz = 5;
  const Landings fast_gimbal = LandOnCar(GetParam(), true, {});
  const Landings slow_gimbal = LandOnCar(GetParam(), true, slow);
  RecordProperty("fixed_median_m", std::to_string(fixed.median_m()));
  RecordProperty("fixed_largest_m", std::to_string(fixed.largest_m()));
  RecordProperty("gimbal_median_m", std::to_string(fast_gimbal.median_m()));
  RecordProperty("gimbal_largest_m", std::to_string(fast_gimbal.largest_m()));
  RecordProperty("late_gimbal_median_m", std::to_string(slow_gimbal.median_m()));
  RecordProperty("late_gimbal_largest_m", std::to_string(slow_gimbal.largest_m()));
  constexpr double kMargin_m = 0.03;
  EXPECT_LT(fast_gimbal.median_m(), fixed.median_m() + kMargin_m);
  EXPECT_LT(slow_gimbal.median_m(), fixed.median_m() + kMargin_m);
}

}  // namespace
}  // namespace kestrel
