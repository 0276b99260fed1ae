// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/flight_limits.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kestrel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

SetPoint Moving(const Vector3d& velocity, const Vector3d& acceleration = Vector3d::Zero()) {
  return {velocity, acceleration, std::nullopt};
}

TEST(FlightLimitsTest, LimitsSpeedAndAccelerationAlongTheirDirections) {
  const FlightLimits limits({}, {0, 0});
  const SetPoint limited = limits.Limited(Moving({30, 40, 9}, {-30, 0, 0}), {0, 0, 10}, true);
  EXPECT_LT((limited.velocity - Vector3d(6, 8, 2.5)).norm(), 1e-9);
  EXPECT_NEAR(limited.acceleration.x(), -9.81 * std::tan(30 * EIGEN_PI / 180), 1e-9);
  EXPECT_NEAR(limits.Limited(Moving({0, 0, -9}), {0, 0, 10}, true).velocity.z(), -1.5, 1e-9);
  const SetPoint small = Moving({1, 2, -0.5}, {1, 0, 0});
  EXPECT_EQ(limits.Limited(small, {0, 0, 10}, true).velocity, small.velocity);
}

TEST(FlightLimitsTest, BrakesBeforeFenceAndReturnsFromBeyond) {
  const FlightLimits limits({}, {100, 0});
  const auto outwards = [&](double x_m) {
    return limits.Limited(Moving({10, 3, 0}), {x_m, 0, 10}, true).velocity;
  };
  EXPECT_NEAR(outwards(150).x(), 9.578, 0.001) << "no faster than it may";
  EXPECT_LT(outwards(195).x(), 4);
  EXPECT_GT(outwards(195).y(), 2.8) << "along the fence it may fly";
  EXPECT_LT(outwards(210).x(), -2);
  EXPECT_EQ(limits.Limited(Moving({-10, 0, 0}), {199, 0, 10}, true).velocity.x(), -10);
}

TEST(FlightLimitsTest, FloorAppliesToFlightWithoutTarget) {
  const FlightLimits limits({}, {0, 0});
  const auto climb = [&](double z_m, bool follows) {
    return limits.Limited(Moving({0, 0, -1}), {0, 0, z_m}, follows).velocity.z();
  };
  EXPECT_EQ(climb(2, true), -1);
  EXPECT_EQ(climb(10, false), -1);
  EXPECT_NEAR(climb(3, false), 0, 1e-9);
  EXPECT_GT(climb(2, false), 0.5);
  EXPECT_NEAR(limits.Limited(Moving({0, 0, 2}), {0, 0, 30}, true).velocity.z(), 0, 1e-9);
}

TEST(FlightLimitsTest, ReportsInOneLineWhyItMustNotStart) {
  const FlightLimits limits({}, {10, 0});
  EXPECT_THAT(limits.WhyNot({0, 0, 10}), IsEmpty());
  EXPECT_THAT(
      limits.WhyNot({-95, 0, 10}),
      HasSubstr("105.0 m from the middle of the geofence, limits.geofence_radius_m is 100"));
  EXPECT_THAT(limits.WhyNot({0, 0, 31}), HasSubstr("31.0 m high, limits.ceiling_m is 30"));
  EXPECT_FALSE(limits.Contains({-95, 0, 10}));
}

TEST(FlightLimitsTest, ReportsLimitsBeyondThoseOfAutopilot) {
  EXPECT_THAT(ViolationsOf({}, {}), IsEmpty()) << "nothing known";
  // ArduCopter's and PX4's defaults.
  EXPECT_THAT(ViolationsOf({.max_climb_mps = 2.5, .max_sink_mps = 1.5, .max_tilt_deg = 30}, {}),
              IsEmpty());
  EXPECT_THAT(
      ViolationsOf(
          {.max_speed_mps = 12, .max_climb_mps = 3, .max_sink_mps = 1.5, .max_tilt_deg = 45}, {}),
      IsEmpty());
  EXPECT_THAT(ViolationsOf({.max_speed_mps = 5, .max_tilt_deg = 20}, {}),
              ElementsAre("limits.max_speed_mps is 10 m/s, the autopilot's own limit is 5 m/s",
                          "limits.max_tilt_deg is 30 deg, the autopilot's own limit is 20 deg"));
}

}  // namespace
}  // namespace kestrel
