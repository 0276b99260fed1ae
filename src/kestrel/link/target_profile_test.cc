// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/link/target_profile.h"

#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "kestrel/geometry/angles.h"
#include "kestrel/link/mavlink_enums.h"

namespace kestrel {
namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;

// A UAV 5 m above and 2 m south of the target that looks east and is level.
TargetReport LookingEast() {
  TargetReport report;
  report.world_from_body.translation = {10, 18, 6};
  report.position_in_world = {10, 20, 1};
  report.velocity_in_world = {3, 4, 0};
  report.covariance_in_world = Vector3d(0.04, 0.09, 0.01).asDiagonal();
  return report;
}

TEST(TargetProfileTest, ArduPilotGetsTheTargetInTheBodysAxes) {
  const mavlink::LandingTarget message = ArduPilotTarget(LookingEast(), 77, Vector3d::Zero(), 1);
  EXPECT_EQ(message.time_usec, 77u);
  EXPECT_EQ(message.frame, mavlink::kFrameBodyFrd);
  EXPECT_EQ(message.position_valid, 1);
  EXPECT_NEAR(message.x, 0, 1e-6);   // forward is east
  EXPECT_NEAR(message.y, -2, 1e-6);  // north is to the left
  EXPECT_NEAR(message.z, 5, 1e-6);
  EXPECT_NEAR(message.distance, std::sqrt(29), 1e-6);
  // As ArduPilot makes a line of sight of the angles.
  EXPECT_NEAR(std::tan(message.angle_x), -0.4, 1e-6);
  EXPECT_NEAR(-std::tan(message.angle_y), 0, 1e-6);
}

TEST(TargetProfileTest, ArduPilotsOwnCameraOffsetIsTakenOff) {
  const Vector3d camera_in_frd(0.1, 0.2, 0.3);
  const mavlink::LandingTarget message = ArduPilotTarget(LookingEast(), 0, camera_in_frd, 1);
  EXPECT_NEAR(message.x, -0.1, 1e-6);
  EXPECT_NEAR(message.y, -2.2, 1e-6);
  EXPECT_NEAR(message.z, 4.7, 1e-6);
}

TEST(TargetProfileTest, Px4GetsAPlaceInItsLocalFrame) {
  const mavlink::LandingTarget message = Px4Target(LookingEast(), 5);
  EXPECT_EQ(message.frame, mavlink::kFrameLocalNed);
  EXPECT_EQ(message.position_valid, 1);
  EXPECT_FLOAT_EQ(message.x, 20);
  EXPECT_FLOAT_EQ(message.y, 10);
  EXPECT_FLOAT_EQ(message.z, -1);
}

TEST(TargetProfileTest, TheTargetEstimatorGetsTheUncertaintyAlongTheBodysAxes) {
  const mavlink::TargetRelative message = Px4VteTarget(LookingEast(), 5);
  EXPECT_EQ(message.frame, mavlink::kTargetFrameBodyFrd);
  EXPECT_NEAR(message.y, -2, 1e-6);
  EXPECT_NEAR(message.pos_std[0], 0.2, 1e-6);
  EXPECT_NEAR(message.pos_std[1], 0.3, 1e-6);
  EXPECT_NEAR(message.pos_std[2], 0.1, 1e-6);
  // From the body's axes to NED: forward is east.
  const Eigen::Quaterniond ned_from_frd(message.q_sensor[0], message.q_sensor[1],
                                        message.q_sensor[2], message.q_sensor[3]);
  EXPECT_LT((ned_from_frd * Vector3d::UnitX() - Vector3d::UnitY()).norm(), 1e-6);
  EXPECT_LT((ned_from_frd * Vector3d(message.x, message.y, message.z) - Vector3d(2, 0, 5)).norm(),
            1e-6);
}

TEST(TargetProfileTest, ATiltedUavSeesTheTargetAside) {
  TargetReport report = LookingEast();
  report.position_in_world = {10, 18, 1};                                        // straight below
  report.world_from_body.rotation = AngleAxisd(Radians(20), Vector3d::UnitX());  // left side up
  const mavlink::LandingTarget message = ArduPilotTarget(report, 0, Vector3d::Zero(), 1);
  EXPECT_NEAR(message.y, 5 * std::sin(Radians(20)), 1e-6);
  EXPECT_NEAR(message.z, 5 * std::cos(Radians(20)), 1e-6);
}

TEST(TargetProfileTest, TheDistanceIsTheHeightAboveTheTarget) {
  const mavlink::DistanceSensor message = TargetDistance(LookingEast(), 12, 0.2, 30);
  EXPECT_EQ(message.current_distance, 500);
  EXPECT_EQ(message.orientation, mavlink::kOrientationDown);
  EXPECT_EQ(message.covariance, 100);  // cm^2
}

TEST(TargetProfileTest, TheTargetToFollowIsAPlaceOnTheGlobe) {
  const GlobalPosition origin{600'000'000, 140'000'000, 300};
  const mavlink::FollowTarget message =
      TargetToFollow(LookingEast(), AutopilotKind::kPx4, origin, 3);
  const double metre_deg = Degrees(1 / 6371000.0);
  EXPECT_NEAR(1e-7 * message.lat, 60 + 20 * metre_deg, 3e-7);
  EXPECT_NEAR(1e-7 * message.lon, 14 + 10 * metre_deg / 0.5, 3e-7);
  EXPECT_FLOAT_EQ(message.alt, 301);
  EXPECT_FLOAT_EQ(message.vel[0], 4);
  EXPECT_FLOAT_EQ(message.vel[1], 3);
}

TEST(TargetProfileTest, NamesAreReadBack) {
  for (const auto profile : {LinkProfile::kArduPilot, LinkProfile::kPx4, LinkProfile::kPx4Vte}) {
    EXPECT_EQ(ParseLinkProfile(ToString(profile)), profile);
  }
  EXPECT_FALSE(ParseLinkProfile("betaflight"));
}

}  // namespace
}  // namespace kestrel
