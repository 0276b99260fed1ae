// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/target_profile.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

constexpr float kTolerance = 1e-5f;

// A UAV 5 m above the ground that heads north. The target is 2 m north and 1 m east of it on a
// board of 1 m, and heads east.
TargetState Report() {
  TargetState report;
  report.time = TimeFromNanoseconds(1'000'000'000);
  report.world_from_body.translation = {10, 20, 5};
  report.world_from_body.rotation =
      Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ());
  report.position_in_world = {11, 22, 1};
  report.velocity_in_world = {4, 3, 0};
  report.covariance = Eigen::Vector3d(0.01, 0.04, 0.0009).asDiagonal();
  report.yaw = 0;
  report.yaw_sigma = 0.1;
  report.size_m = 1;
  return report;
}

TEST(TargetProfileTest, SendsArduPilotTargetRelativeToBody) {
  const auto message = LandingTargetForArduPilot(Report(), 1234);
  EXPECT_EQ(message.frame, mavlink::kFrameBodyFrd);
  EXPECT_EQ(message.position_valid, 1);
  EXPECT_EQ(message.type, mavlink::kTargetTypeVisionOther);
  EXPECT_EQ(message.time_usec, 1234u);
  EXPECT_NEAR(message.x, 2, kTolerance);
  EXPECT_NEAR(message.y, 1, kTolerance);
  EXPECT_NEAR(message.z, 4, kTolerance);
  EXPECT_NEAR(message.distance, std::sqrt(21.0), kTolerance);
  // ArduPilot's line of sight: (-tan(angle_y), tan(angle_x), 1).
  EXPECT_NEAR(-std::tan(message.angle_y), message.x / message.z, kTolerance);
  EXPECT_NEAR(std::tan(message.angle_x), message.y / message.z, kTolerance);
  EXPECT_NEAR(message.size_x, 1 / std::sqrt(21.0), 2e-3);
  // Turned to the right by 90 degrees.
  EXPECT_NEAR(message.q[0], std::sqrt(0.5), kTolerance);
  EXPECT_NEAR(message.q[3], std::sqrt(0.5), kTolerance);
}

TEST(TargetProfileTest, AccountsForTiltOfBody) {
  TargetState report = Report();
  report.position_in_world = report.world_from_body.translation - Eigen::Vector3d(0, 0, 4);
  // Nose down by 0.2 rad.
  report.world_from_body.rotation =
      report.world_from_body.rotation * Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY());
  const auto message = LandingTargetForArduPilot(report, 0);
  EXPECT_NEAR(message.x, 4 * std::sin(0.2), kTolerance);
  EXPECT_NEAR(message.y, 0, kTolerance);
  EXPECT_NEAR(message.z, 4 * std::cos(0.2), kTolerance);
}

TEST(TargetProfileTest, SendsPx4TargetInLocalFrame) {
  const auto message = LandingTargetForPx4(Report(), 1234);
  EXPECT_EQ(message.frame, mavlink::kFrameLocalNed);
  EXPECT_EQ(message.position_valid, 1);
  EXPECT_NEAR(message.x, 22, kTolerance);
  EXPECT_NEAR(message.y, 11, kTolerance);
  EXPECT_NEAR(message.z, -1, kTolerance);
  EXPECT_NEAR(message.q[0], std::sqrt(0.5), kTolerance);  // heading east
  EXPECT_NEAR(message.q[3], std::sqrt(0.5), kTolerance);
}

TEST(TargetProfileTest, SendsUncertaintyToPx4Estimator) {
  const auto message = TargetRelativeForPx4(Report(), 1234);
  EXPECT_EQ(message.frame, mavlink::kTargetFrameBodyFrd);
  EXPECT_EQ(message.timestamp, 1234u);
  EXPECT_NEAR(message.x, 2, kTolerance);
  EXPECT_NEAR(message.y, 1, kTolerance);
  EXPECT_NEAR(message.z, 4, kTolerance);
  EXPECT_NEAR(message.pos_std[0], 0.2, kTolerance);
  EXPECT_NEAR(message.pos_std[1], 0.1, kTolerance);
  EXPECT_NEAR(message.pos_std[2], 0.03, kTolerance);
  EXPECT_NEAR(message.yaw_std, 0.1, kTolerance);
  EXPECT_NEAR(message.q_sensor[0], 1, kTolerance);  // the body heads north
}

TEST(TargetProfileTest, MeasuresDistanceDown) {
  const auto message = DistanceSensorOf(Report(), 40, 99);
  ASSERT_TRUE(message);
  EXPECT_EQ(message->current_distance, 400);
  EXPECT_EQ(message->orientation, mavlink::kOrientationDown);
  EXPECT_EQ(message->covariance, 9);
  EXPECT_FALSE(DistanceSensorOf(Report(), 3, 99));
  TargetState above = Report();
  above.position_in_world.z() = 6;
  EXPECT_FALSE(DistanceSensorOf(above, 40, 99));
}

TEST(TargetProfileTest, SendsGlobalPositionToFollowers) {
  const GlobalPosition origin{473977418, 85455939, 488};
  const auto message = FollowTargetOf(Report(), AutopilotKind::kPx4, origin, 5);
  const Eigen::Vector3d back =
      LocalFromGlobal(AutopilotKind::kPx4, origin, {message.lat, message.lon, message.alt});
  EXPECT_LT((back - Eigen::Vector3d(11, 22, 1)).norm(), 0.02);
  EXPECT_EQ(message.est_capabilities, 3);
  EXPECT_EQ(message.vel[0], 3);
  EXPECT_EQ(message.vel[1], 4);
}

TEST(TargetProfileTest, KnowsItsNames) {
  EXPECT_EQ(ParseLinkProfile("px4-vte"), LinkProfile::kPx4Vte);
  EXPECT_THROW(ParseLinkProfile("apm"), InputError);
  EXPECT_EQ(ProfileFor(AutopilotKind::kPx4), LinkProfile::kPx4);
  EXPECT_EQ(ProfileFor(AutopilotKind::kOther), LinkProfile::kArduPilot);
}

}  // namespace
}  // namespace kestrel
