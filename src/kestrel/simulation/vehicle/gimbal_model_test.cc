// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/vehicle/gimbal_model.h"

#include <cmath>

#include <gtest/gtest.h>

#include "kestrel/core/geometry/angles.h"
#include "kestrel/simulation/vehicle/flight_time.h"

namespace kestrel {
namespace {

using Eigen::Vector3d;

constexpr double kHeading = 0.7;

// The UAV hovers at 10 m and leans; its heading is constant.
RigidTransform Hovering(double time_s) {
  return {RotationBy(kHeading * Vector3d::UnitZ()) * RotationBy({0.2 * std::sin(time_s), 0, 0}),
          {0, 0, 10}};
}

GimbalOptions Reporting(const std::string& frame) {
  GimbalOptions options;
  options.rate_hz = 20;
  options.noise_deg = 0;
  options.yaw_frame = frame;
  return options;
}

TEST(SimulatedGimbalTest, LooksAtStandingTargetWhateverTheBodyDoes) {
  const Vector3d target(20, 5, 0);
  const SimulatedGimbal gimbal(
      Reporting("earth"), Hovering, {}, [&](double) { return target; }, 0, 5);
  for (const double time_s : {0.0, 1.3, 4.9}) {
    const RigidTransform platform = gimbal.WorldFromPlatform(time_s);
    const Vector3d ray = platform.rotation * Vector3d::UnitX();
    EXPECT_LT(std::acos(ray.dot((target - platform.translation).normalized())), 1e-6);
  }
}

TEST(SimulatedGimbalTest, TurnsNoFasterThanItsMotors) {
  GimbalOptions options = Reporting("earth");
  options.max_turn_dps = 30;
  const auto jumping = [](double time_s) { return Vector3d(time_s < 1 ? 20 : -20, 20, 0); };
  const SimulatedGimbal gimbal(options, Hovering, {}, jumping, 0, 8);
  const auto turned = [&](double from_s, double to_s) {
    return gimbal.WorldFromPlatform(from_s).rotation.angularDistance(
        gimbal.WorldFromPlatform(to_s).rotation);
  };
  EXPECT_LT(turned(1, 2), Radians(30.5));
  EXPECT_GT(turned(1, 7), Radians(60));
}

TEST(SimulatedGimbalTest, ReportsAttitudeInItsYawFrameWithLateStamp) {
  const auto target = [](double) { return Vector3d(20, 5, 0); };
  for (const char* frame : {"earth", "vehicle"}) {
    GimbalOptions options = Reporting(frame);
    options.stamp_delay_s = 0.1;
    const SimulatedGimbal gimbal(options, Hovering, {}, target, 0, 5);
    const auto reports = gimbal.Reports(/*clock_offset_s=*/0.25, /*world_yaw_rad=*/0.3, Random(1));
    ASSERT_GE(reports.size(), 100u);
    EXPECT_EQ(reports[20].time, TimeOfFlight(1 + 0.25 + 0.1));
    const bool is_earth = reports[20].yaw_frame == YawFrame::kEarth;
    EXPECT_EQ(is_earth, std::string(frame) == "earth");
    const double turn = is_earth ? 0.3 : -kHeading;
    const Eigen::Quaterniond expected =
        RotationBy(turn * Vector3d::UnitZ()) * gimbal.WorldFromPlatform(1).rotation;
    EXPECT_LT(reports[20].level_from_platform.angularDistance(expected), 0.02);
  }
}

}  // namespace
}  // namespace kestrel
