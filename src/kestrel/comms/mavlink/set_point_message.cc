// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/set_point_message.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/comms/mavlink/ned.h"

namespace kestrel {

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
    constexpr double kTurn = 2 * std::numbers::pi;
    message.type_mask |= mavlink::kIgnoreYawRate;
    message.yaw = static_cast<float>(std::remainder(kTurn / 4 - *set_point.yaw, kTurn));
  } else {
    message.type_mask |= mavlink::kIgnoreYaw;
    if (kind != AutopilotKind::kArduPilot) message.type_mask |= mavlink::kIgnoreYawRate;
  }
  return message;
}

bool SendSetPoint(const SetPoint& set_point, const Autopilot& autopilot, Time now,
                  Connection* connection) {
  constexpr std::int64_t kNsPerMs = 1'000'000;
  if (!set_point.velocity.allFinite() || !set_point.acceleration.allFinite() ||
      !std::isfinite(set_point.yaw.value_or(0)) ||
      !set_point.place.value_or(Eigen::Vector3d::Zero()).allFinite()) {
    return false;
  }
  const TimeSync& clock = autopilot.time_sync();
  const std::int64_t boot_ms = clock.is_known() ? clock.ToRemote(now) / kNsPerMs : 0;
  return connection->Send(
      SetPointMessage(set_point, autopilot.kind(), autopilot.system(), autopilot.component(),
                      static_cast<std::uint32_t>(std::max<std::int64_t>(boot_ms, 0))));
}

}  // namespace kestrel
