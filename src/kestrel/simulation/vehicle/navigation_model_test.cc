// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/vehicle/navigation_model.h"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "kestrel/core/base/options.h"
#include "kestrel/simulation/vehicle/flight_time.h"

namespace kestrel {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

RigidTransform MovingAt(double time_s) {
  return {Quaterniond(AngleAxisd(0.3 * time_s, Vector3d::UnitZ())), {2 * time_s, -time_s, 5}};
}

NavigationOptions Perfect() {
  NavigationOptions options;
  options.position_noise_m = options.position_drift_m = options.position_bias_m = 0;
  options.attitude_noise_deg = options.attitude_bias_deg = options.mount_error_deg = 0;
  options.clock_offset_min_s = options.clock_offset_max_s = 0.2;
  return options;
}

TEST(NavigationModelTest, OffsetConvertsImageTimeToNavigationTime) {
  Random random(1);
  const NavigationErrors errors = DrawNavigationErrors(Perfect(), &random);
  const auto poses = NavigationSensor(Perfect(), errors, random).ReportAll(MovingAt, -0.5, 1.5);
  PoseHistory history(poses.size(), std::chrono::seconds(1));
  for (const PoseSample& pose : poses) ASSERT_EQ(history.Add(pose), PoseStatus::kOk);
  const auto found = history.Lookup(TimeOfFlight(0.777) + DurationFromSeconds(0.2));
  ASSERT_TRUE(found);
  EXPECT_LT((found->translation - MovingAt(0.777).translation).norm(), 1e-6);
  EXPECT_LT(found->rotation.angularDistance(MovingAt(0.777).rotation), 1e-6);
}

TEST(NavigationModelTest, WorldMayBeShiftedAndTurned) {
  NavigationOptions options = Perfect();
  options.origin_x_m = 3;
  options.origin_y_m = -1;
  options.world_yaw_deg = 90;
  const RigidTransform truth{Quaterniond::Identity(), {2, 1, 5}};
  const RigidTransform reported =
      NavigationSensor(options, {}, Random(1)).Report(0, truth).world_from_body;
  EXPECT_LT((reported.translation - Vector3d(3 - 1, -1 + 2, 5)).norm(), 1e-9);
  EXPECT_NEAR(HeadingOf(reported.rotation), std::numbers::pi / 2, 1e-9);
}

TEST(NavigationModelTest, NoiseHasRequestedSpread) {
  NavigationOptions options = Perfect();
  options.position_noise_m = 0.05;
  options.attitude_noise_deg = 0.5;
  const auto poses = NavigationSensor(options, {}, Random(2)).ReportAll(MovingAt, 0, 40);
  double position = 0;
  double attitude = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const RigidTransform truth = MovingAt(0.01 * static_cast<double>(i));
    position += (poses[i].world_from_body.translation - truth.translation).squaredNorm();
    attitude += std::pow(poses[i].world_from_body.rotation.angularDistance(truth.rotation), 2);
  }
  const double deg = 180 / std::numbers::pi;
  EXPECT_NEAR(std::sqrt(position / (3 * poses.size())), 0.05, 0.002);
  EXPECT_NEAR(deg * std::sqrt(attitude / (3 * poses.size())), 0.5, 0.02);
}

TEST(NavigationModelTest, MountErrorRotatesInBodyFrame) {
  NavigationErrors errors;
  errors.mount_yaw_deg = 90;
  const RigidTransform nominal{Quaterniond::Identity(), {0.1, 0.2, 0.3}};
  const RigidTransform mount = errors.TrueMount(nominal);
  EXPECT_EQ(mount.translation, nominal.translation);
  EXPECT_LT((mount.rotation * Vector3d::UnitX() - Vector3d::UnitY()).norm(), 1e-12);
}

TEST(NavigationModelTest, ErrorsAreDrawnWithinTheirRange) {
  NavigationOptions options;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    const double offset = DrawNavigationErrors(options, &random).clock_offset_s;
    ASSERT_GE(offset, -0.1);
    ASSERT_LE(offset, 0.3);
  }
  options.clock_offset_max_s = -0.2;
  EXPECT_EQ(ViolationsOf(options).at(0), "clock_offset_max_s is -0.2, expected -0.1 to 10");
}

}  // namespace
}  // namespace kestrel
