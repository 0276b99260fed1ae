// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/set_point_message.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/comms/mavlink/ned.h"
#include "kestrel/core/poses/gravity.h"

namespace kestrel {
namespace {

// The heading of NED, clockwise from north, of a yaw from east to north; rad.
float HeadingOfYaw(double yaw) {
  constexpr double kTurn = 2 * std::numbers::pi;
  return static_cast<float>(std::remainder(kTurn / 4 - yaw, kTurn));
}

// The present time on the autopilot's clock; 0 while that is not known.
std::uint32_t BootTime(const Autopilot& autopilot, Time now) {
  constexpr std::int64_t kNsPerMs = 1'000'000;
  const TimeSync& clock = autopilot.time_sync();
  const std::int64_t remote_ms = clock.is_known() ? clock.ToRemote(now) / kNsPerMs : 0;
  return static_cast<std::uint32_t>(std::max<std::int64_t>(remote_ms, 0));
}

mavlink::SetPositionTargetLocalNed InLocalFrame(std::uint8_t system, std::uint8_t component,
                                                std::uint32_t boot_ms) {
  mavlink::SetPositionTargetLocalNed message;
  message.time_boot_ms = boot_ms;
  message.target_system = system;
  message.target_component = component;
  message.coordinate_frame = mavlink::kFrameLocalNed;
  return message;
}

}  // namespace

mavlink::SetPositionTargetLocalNed SetPointMessage(const SetPoint& set_point, AutopilotKind kind,
                                                   std::uint8_t system, std::uint8_t component,
                                                   std::uint32_t boot_ms) {
  const Eigen::Vector3f velocity = NedFromEnu(set_point.velocity).cast<float>();
  const Eigen::Vector3f acceleration = NedFromEnu(set_point.acceleration).cast<float>();
  auto message = InLocalFrame(system, component, boot_ms);
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

mavlink::SetAttitudeTarget LeanMessage(const LeanSetPoint& set_point, double max_climb_mps,
                                       double max_sink_mps, std::uint8_t system,
                                       std::uint8_t component, std::uint32_t boot_ms) {
  const Eigen::Vector3d up(set_point.acceleration.x(), set_point.acceleration.y(), kGravity);
  const Eigen::Quaterniond lean = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), up);
  const Eigen::AngleAxisd turn(set_point.yaw, Eigen::Vector3d::UnitZ());
  const Eigen::Quaterniond in_ned = NedFrdFromEnuFlu((lean * turn).normalized());
  const double fastest_mps = set_point.climb_mps > 0 ? max_climb_mps : max_sink_mps;
  constexpr double kSlowest_mps = 0.1;  // a limit of 0 is none to divide by
  const double part =
      std::clamp(set_point.climb_mps / std::max(fastest_mps, kSlowest_mps), -1.0, 1.0);
  mavlink::SetAttitudeTarget message;
  message.time_boot_ms = boot_ms;
  message.target_system = system;
  message.target_component = component;
  message.type_mask = mavlink::kIgnoreBodyRates;
  message.q = {static_cast<float>(in_ned.w()), static_cast<float>(in_ned.x()),
               static_cast<float>(in_ned.y()), static_cast<float>(in_ned.z())};
  message.thrust = static_cast<float>(0.5 + 0.5 * part);
  return message;
}

mavlink::SetPositionTargetLocalNed AccelerationMessage(const LeanSetPoint& set_point,
                                                       std::uint8_t system, std::uint8_t component,
                                                       std::uint32_t boot_ms) {
  const Eigen::Vector3f acceleration = NedFromEnu(set_point.acceleration).cast<float>();
  auto message = InLocalFrame(system, component, boot_ms);
  message.type_mask = mavlink::kIgnorePosition | mavlink::kIgnoreVelocity | mavlink::kIgnoreYawRate;
  message.afx = acceleration.x();
  message.afy = acceleration.y();
  message.afz = acceleration.z();
  message.yaw = HeadingOfYaw(set_point.yaw);
  return message;
}

bool SendSetPoint(const SetPoint& set_point, const Autopilot& autopilot, Time now,
                  Connection* connection) {
  if (!set_point.velocity.allFinite() || !set_point.acceleration.allFinite() ||
      !std::isfinite(set_point.yaw.value_or(0)) || !std::isfinite(set_point.yaw_rate.value_or(0)) ||
      !set_point.place.value_or(Eigen::Vector3d::Zero()).allFinite()) {
    return false;
  }
  const std::uint32_t boot_ms = BootTime(autopilot, now);
  if (set_point.is_carried && autopilot.kind() == AutopilotKind::kArduPilot) {
    return connection->Send(
        CarriedMessage(set_point, autopilot.system(), autopilot.component(), boot_ms));
  }
  return connection->Send(SetPointMessage(set_point, autopilot.kind(), autopilot.system(),
                                          autopilot.component(), boot_ms));
}

bool SendSetPoint(const LeanSetPoint& set_point, double max_climb_mps, double max_sink_mps,
                  const Autopilot& autopilot, Time now, Connection* connection) {
  if (!set_point.acceleration.allFinite() || !std::isfinite(set_point.climb_mps) ||
      !std::isfinite(set_point.yaw)) {
    return false;
  }
  const std::uint32_t boot_ms = BootTime(autopilot, now);
  if (autopilot.kind() == AutopilotKind::kPx4) {
    return connection->Send(
        AccelerationMessage(set_point, autopilot.system(), autopilot.component(), boot_ms));
  }
  return connection->Send(LeanMessage(set_point, max_climb_mps, max_sink_mps, autopilot.system(),
                                      autopilot.component(), boot_ms));
}

}  // namespace kestrel
