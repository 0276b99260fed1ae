// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/set_point_message.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/comms/mavlink/ned.h"
#include "kestrel/core/poses/gravity.h"

namespace kestrel {
namespace {

TEST(SetPointMessageTest, IsInLocalNed) {
  SetPoint set_point;
  set_point.velocity = {1, 2, 3};
  set_point.acceleration = {0.1, 0.2, 0.3};
  set_point.yaw = 0;  // east
  const auto message = SetPointMessage(set_point, AutopilotKind::kArduPilot, 7, 1, 1234);
  EXPECT_EQ(message.target_system, 7);
  EXPECT_EQ(message.target_component, 1);
  EXPECT_EQ(message.time_boot_ms, 1234u);
  EXPECT_EQ(message.coordinate_frame, mavlink::kFrameLocalNed);
  EXPECT_EQ(message.type_mask, 0x807) << "velocity, acceleration and yaw";
  EXPECT_FLOAT_EQ(message.vx, 2);
  EXPECT_FLOAT_EQ(message.vy, 1);
  EXPECT_FLOAT_EQ(message.vz, -3);
  EXPECT_FLOAT_EQ(message.afx, 0.2f);
  EXPECT_FLOAT_EQ(message.afy, 0.1f);
  EXPECT_FLOAT_EQ(message.afz, -0.3f);
  EXPECT_FLOAT_EQ(message.yaw, std::numbers::pi / 2);
}

TEST(SetPointMessageTest, SendsTurnRateWithYaw) {
  SetPoint set_point;
  set_point.yaw = 0;
  set_point.yaw_rate = 0.5;  // from east to north
  for (const AutopilotKind kind : {AutopilotKind::kArduPilot, AutopilotKind::kPx4}) {
    const auto message = SetPointMessage(set_point, kind, 1, 1, 0);
    EXPECT_EQ(message.type_mask, 0x007) << "velocity, acceleration, yaw and its rate";
    EXPECT_FLOAT_EQ(message.yaw, std::numbers::pi / 2);
    EXPECT_FLOAT_EQ(message.yaw_rate, -0.5F) << "clockwise";
  }
}

TEST(SetPointMessageTest, KeepsHeadingWithoutYaw) {
  EXPECT_EQ(SetPointMessage({}, AutopilotKind::kPx4, 1, 1, 0).type_mask, 0xc07);
  const auto message = SetPointMessage({}, AutopilotKind::kArduPilot, 1, 1, 0);
  EXPECT_EQ(message.type_mask, 0x407) << "else ArduPilot turns it along the velocity";
  EXPECT_EQ(message.yaw_rate, 0);
}

TEST(SetPointMessageTest, CommandsLevelDescentOnDeck) {
  SetPoint set_point;
  set_point.yaw = 0;  // east
  set_point.velocity = {4, 0, -0.7};
  const auto message = CarriedMessage(set_point, 7, 1, 1234);
  EXPECT_EQ(message.target_system, 7);
  EXPECT_EQ(message.type_mask, 7) << "attitude and thrust, no rates";
  EXPECT_FLOAT_EQ(message.q[0], std::sqrt(0.5F));
  EXPECT_EQ(message.q[1], 0);
  EXPECT_EQ(message.q[2], 0);
  EXPECT_FLOAT_EQ(message.q[3], std::sqrt(0.5F));
  EXPECT_EQ(message.thrust, 0);
}

// GUIDED_NOGPS flies an old lean on where the quaternion is not one.
TEST(LeanMessageTest, IsUnitAttitudeWithClimbRate) {
  const LeanSetPoint set_point{.acceleration = {1.5, -2, 0}, .climb_mps = 0, .yaw = 0.7};
  const mavlink::SetAttitudeTarget level = LeanMessage(set_point, 2.5, 1.5, 1, 1, 0);
  EXPECT_EQ(level.type_mask, mavlink::kIgnoreBodyRates);
  EXPECT_EQ(level.thrust, 0.5F);
  const Eigen::Quaterniond in_ned(level.q[0], level.q[1], level.q[2], level.q[3]);
  EXPECT_NEAR(in_ned.norm(), 1, 1e-6);
  const Eigen::Vector3d up = EnuFluFromNedFrd(in_ned) * Eigen::Vector3d::UnitZ();
  EXPECT_NEAR(up.x() / up.z() * kGravity, 1.5, 1e-4);
  EXPECT_NEAR(up.y() / up.z() * kGravity, -2, 1e-4);
  LeanSetPoint moving = set_point;
  moving.climb_mps = 1.25;
  EXPECT_FLOAT_EQ(LeanMessage(moving, 2.5, 1.5, 1, 1, 0).thrust, 0.75F);
  moving.climb_mps = -3;
  EXPECT_FLOAT_EQ(LeanMessage(moving, 2.5, 1.5, 1, 1, 0).thrust, 0);
}

// One axis of a velocity, and PX4 refuses it without a position.
TEST(AccelerationMessageTest, HasAccelerationAndYawAlone) {
  const LeanSetPoint set_point{.acceleration = {1, 2, 3}, .climb_mps = 1, .yaw = 0};
  const mavlink::SetPositionTargetLocalNed message = AccelerationMessage(set_point, 1, 1, 0);
  EXPECT_EQ(message.type_mask, 0x83F);
  EXPECT_EQ(message.coordinate_frame, mavlink::kFrameLocalNed);
  EXPECT_FLOAT_EQ(message.afx, 2);
  EXPECT_FLOAT_EQ(message.afy, 1);
  EXPECT_FLOAT_EQ(message.afz, -3);
}

TEST(SetPointMessageTest, DoesNotSendNonFiniteValues) {
  int sent = 0;
  Connection connection("udpout://127.0.0.1:9", {}, [&](auto, Time) { ++sent; });
  const Autopilot autopilot({}, &connection, {});
  SetPoint set_point;
  EXPECT_TRUE(SendSetPoint(set_point, autopilot, Time(), &connection));
  set_point.acceleration.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(SendSetPoint(set_point, autopilot, Time(), &connection));
  EXPECT_EQ(sent, 1);
}

}  // namespace
}  // namespace kestrel
