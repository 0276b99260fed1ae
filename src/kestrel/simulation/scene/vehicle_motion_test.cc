// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/scene/vehicle_motion.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "kestrel/core/base/options.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

using Eigen::Vector3d;

TEST(VehicleMotionTest, VehicleKeepsItsSpeedAndLooksAhead) {
  for (const char* path : {"straight", "circle", "figure8"}) {
    Random random(5);
    VehicleMotionOptions options;
    options.path = path;
    options.speed_mps = 8.3;
    const Motion motion = VehicleMotion(options, &random);
    for (double time_s = 0; time_s < 20; time_s += 0.5) {
      const Vector3d velocity = VelocityOf(motion, time_s);
      ASSERT_NEAR(velocity.norm(), 8.3, 0.4) << path;
      ASSERT_GT((motion(time_s).rotation * Vector3d::UnitX()).dot(velocity.normalized()), 0.999);
    }
  }
}

TEST(VehicleMotionTest, ChangesLanesSoftly) {
  Random random(5);
  VehicleMotionOptions options;
  options.path = "lanes";
  options.speed_mps = 13.9;
  const Motion motion = VehicleMotion(options, &random);
  const Vector3d ahead =
      (motion(options.lane_period_s).translation - motion(0).translation).normalized();
  double least_m = 0, most_m = 0, largest_acceleration = 0;
  for (double time_s = 0; time_s < 24; time_s += 0.1) {
    const double beside_m = ahead.cross(motion(time_s).translation - motion(0).translation).z();
    least_m = std::min(least_m, beside_m);
    most_m = std::max(most_m, beside_m);
    const Vector3d change = VelocityOf(motion, time_s + 0.05) - VelocityOf(motion, time_s - 0.05);
    largest_acceleration = std::max(largest_acceleration, change.norm() / 0.1);
  }
  EXPECT_NEAR(most_m - least_m, 3.5, 0.05);
  EXPECT_LT(largest_acceleration, 1.5);
}

TEST(VehicleMotionTest, StopsAndTurnsInPlace) {
  Random random(5);
  VehicleMotionOptions options;
  options.path = "stops";
  options.shake_deg = 0;
  const Motion motion = VehicleMotion(options, &random);
  double fastest_mps = 0;
  double turned = 0;
  for (double time_s = 0; time_s < 64; time_s += 0.1) {
    const double speed_mps = VelocityOf(motion, time_s).norm();
    fastest_mps = std::max(fastest_mps, speed_mps);
    const double turn = motion(time_s).rotation.angularDistance(motion(time_s + 0.1).rotation);
    if (turn > 1e-6) {
      EXPECT_LT(speed_mps, 0.01) << "at " << time_s << " s";
    }
    turned += turn;
  }
  EXPECT_NEAR(fastest_mps, 4.2, 0.01);
  EXPECT_NEAR(turned, 2 * kPi, 0.01);
  EXPECT_LT((motion(64).translation - motion(0).translation).norm(), 1e-6) << "a square";
}

TEST(VehicleMotionTest, HeavesAndRollsOnWaves) {
  Random random(5);
  VehicleMotionOptions options;
  options.path = "standing";
  options.heave_m = 1;
  options.roll_deg = 8;
  const Motion motion = VehicleMotion(options, &random);
  double least_m = 10, most_m = 0, largest_tilt = 0;
  for (double time_s = 0; time_s < 60; time_s += 0.05) {
    const double z_m = motion(time_s).translation.z();
    least_m = std::min(least_m, z_m);
    most_m = std::max(most_m, z_m);
    largest_tilt =
        std::max(largest_tilt, std::acos((motion(time_s).rotation * Vector3d::UnitZ()).z()));
  }
  EXPECT_NEAR(most_m - least_m, 1, 0.01);
  EXPECT_GT(least_m, 0);
  EXPECT_GT(Degrees(largest_tilt), 8);
  EXPECT_LT(Degrees(largest_tilt), 9.1);
}

TEST(VehicleMotionTest, RefusesInvalidOptions) {
  VehicleMotionOptions vehicle;
  vehicle.path = "spiral";
  EXPECT_EQ(ViolationsOf(vehicle).at(0),
            "path is 'spiral', expected standing, straight, circle, figure8, lanes or stops");
}

}  // namespace
}  // namespace kestrel
