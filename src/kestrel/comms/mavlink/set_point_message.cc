// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/set_point_message.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/comms/mavlink/ned.h"

namespace kestrel {
namespace {

// The heading of NED, clockwise from north, of a yaw from east to north; rad.
float HeadingOfYaw(double yaw) {
  constexpr double kTurn = 2 * std::numbers::pi;
  return static_cast<float>(std::remainder(kTurn / 4 - yaw, kTurn));
}

}  // namespace

mavlink::SetPositionTargetLocalNed SetPointMessage(const SetPoint& set_point, AutopilotKind kind,
                                                   std::uint8_t system, std::uint8_t component,
                                                   std::uint32_t boot_ms) {
  const Eigen::Vector3f velocity = NedFromEnu(set_point.velocity).cast<float>();
  const Eigen::Vector3f acceleration = NedFromEnu(set_point.acceleration).cast<float>();
  mavlink::SetPositionTargetLocalNed message;
  message.time_boot_ms = boot_ms;
  message.target_system = system;
  message.target_component = component;
  message.coordinate_frame = mavlink::kFrameLocalNed;
  if (set_point.place) {
    const Eigen::Vector3f place = NedFromEnu(*set_point.place).cast<float>();
    message.type_mask = mavlink::kIgnoreVelocity;
    message.x = place.x();
    message.y = place.y();
    message.z = place.z();
  } else {
    message.type_mask = mavlink::kIgnorePosition;
    message.vx = velocity.x();
    message.vy = velocity.y();
    message.vz = velocity.z();
  }
  message.afx = acceleration.x();
  message.afy = acceleration.y();
  message.afz = acceleration.z();
  if (set_point.yaw) {
    message.yaw = HeadingOfYaw(*set_point.yaw);
    if (set_point.yaw_rate) {
      message.yaw_rate = static_cast<float>(-*set_point.yaw_rate);
    } else {
      message.type_mask |= mavlink::kIgnoreYawRate;
    }
  } else {
    message.type_mask |= mavlink::kIgnoreYaw;
    if (kind != AutopilotKind::kArduPilot) message.type_mask |= mavlink::kIgnoreYawRate;
  }
  return message;
}

mavlink::SetAttitudeTarget LevelMessage(float heading, float thrust, std::uint8_t system,
                                        std::uint8_t component, std::uint32_t boot_ms) {
  const float half = 0.5F * heading;
  mavlink::SetAttitudeTarget message;
  message.time_boot_ms = boot_ms;
  message.target_system = system;
  message.target_component = component;
  message.type_mask = mavlink::kIgnoreBodyRates;
  message.q = {std::cos(half), 0, 0, std::sin(half)};
  message.thrust = thrust;
  return message;
}

mavlink::SetAttitudeTarget CarriedMessage(const SetPoint& set_point, std::uint8_t system,
                                          std::uint8_t component, std::uint32_t boot_ms) {
  return LevelMessage(HeadingOfYaw(set_point.yaw.value_or(0)), 0, system, component, boot_ms);
}

bool SendSetPoint(const SetPoint& set_point, const Autopilot& autopilot, Time now,
                  Connection* connection) {
  constexpr std::int64_t kNsPerMs = 1'000'000;
  if (!set_point.velocity.allFinite() || !set_point.acceleration.allFinite() ||
      !std::isfinite(set_point.yaw.value_or(0)) || !std::isfinite(set_point.yaw_rate.value_or(0)) ||
      !set_point.place.value_or(Eigen::Vector3d::Zero()).allFinite()) {
    return false;
  }
  const TimeSync& clock = autopilot.time_sync();
  const std::int64_t remote_ms = clock.is_known() ? clock.ToRemote(now) / kNsPerMs : 0;
  const auto boot_ms = static_cast<std::uint32_t>(std::max<std::int64_t>(remote_ms, 0));
  if (set_point.is_carried && autopilot.kind() == AutopilotKind::kArduPilot) {
    return connection->Send(
        CarriedMessage(set_point, autopilot.system(), autopilot.component(), boot_ms));
  }
  return connection->Send(SetPointMessage(set_point, autopilot.kind(), autopilot.system(),
                                          autopilot.component(), boot_ms));
}

}  // namespace kestrel
