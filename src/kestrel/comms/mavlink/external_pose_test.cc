// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/external_pose.h"

#include <cmath>

#include <gtest/gtest.h>

#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

ExternalPose SomePose() {
  ExternalPose pose;
  pose.frame_from_body = {
      Eigen::Quaterniond(Eigen::AngleAxisd(Radians(30), Eigen::Vector3d::UnitZ()) *
                         Eigen::AngleAxisd(Radians(10), Eigen::Vector3d::UnitX())),
      {1, 2, 3}};
  pose.covariance = Eigen::Vector3d(0.04, 0.09, 0.01).asDiagonal();
  pose.tilt_sigma = 0.02;
  pose.heading_sigma = 0.1;
  pose.resets = 3;
  return pose;
}

TEST(OdometryOf, UsesFramesOfBothAutopilots) {
  for (const AutopilotKind kind : {AutopilotKind::kArduPilot, AutopilotKind::kPx4}) {
    const mavlink::Odometry message = OdometryOf(SomePose(), kind, 1234);
    EXPECT_EQ(message.time_usec, 1234u);
    EXPECT_EQ(message.frame_id, 20);        // MAV_FRAME_LOCAL_FRD
    EXPECT_EQ(message.child_frame_id, 12);  // MAV_FRAME_BODY_FRD
    EXPECT_EQ(message.reset_counter, 3);
    EXPECT_FLOAT_EQ(message.x, 2);  // north
    EXPECT_FLOAT_EQ(message.y, 1);
    EXPECT_FLOAT_EQ(message.z, -3);
    // 30 degrees from east to north are a heading of 60 degrees; a roll to the right stays one.
    const Eigen::Quaternionf sent(message.q[0], message.q[1], message.q[2], message.q[3]);
    const Eigen::Quaternionf expected =
        Eigen::Quaternionf(Eigen::AngleAxisf(Radians(60), Eigen::Vector3f::UnitZ())) *
        Eigen::AngleAxisf(Radians(10), Eigen::Vector3f::UnitX());
    EXPECT_LT(sent.angularDistance(expected), 1e-3);
    EXPECT_TRUE(std::isnan(message.vx) && std::isnan(message.vy) && std::isnan(message.vz));
  }
}

TEST(OdometryOf, GivesVariancesToPx4) {
  const auto& covariance = OdometryOf(SomePose(), AutopilotKind::kPx4, 1).pose_covariance;
  EXPECT_FLOAT_EQ(covariance[0], 0.09f);  // x is north
  EXPECT_FLOAT_EQ(covariance[6], 0.04f);
  EXPECT_FLOAT_EQ(covariance[11], 0.01f);
  EXPECT_FLOAT_EQ(covariance[15], 0.0004f);
  EXPECT_FLOAT_EQ(covariance[20], 0.01f);
}

// It reads cbrt(a² + b² + c²) as a standard deviation.
TEST(OdometryOf, GivesDeviationsAsArduPilotReadsThem) {
  const auto& covariance = OdometryOf(SomePose(), AutopilotKind::kArduPilot, 1).pose_covariance;
  const auto read = [&](std::size_t a, std::size_t b, std::size_t c) {
    return std::cbrt(std::pow(covariance[a], 2) + std::pow(covariance[b], 2) +
                     std::pow(covariance[c], 2));
  };
  EXPECT_NEAR(read(0, 6, 11), std::sqrt((0.04 + 0.09 + 0.01) / 3), 1e-6);
  EXPECT_NEAR(read(15, 18, 20), 0.1, 1e-6);
}

}  // namespace
}  // namespace kestrel
