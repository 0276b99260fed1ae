// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/autopilots/set_point_reading.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/comms/mavlink/ned.h"
#include "kestrel/core/poses/gravity.h"

namespace kestrel {
namespace {

constexpr double kNorth = std::numbers::pi / 2;

bool IsOfBody(std::uint8_t frame) {
  return frame == mavlink::kFrameBodyNed || frame == mavlink::kFrameBodyOffsetNed;
}

}  // namespace

double HeadingOf(const FlightState& state) {
  return HeadingOf(state.pose.world_from_body.rotation);
}

std::optional<AttitudeOrder> AttitudeOrderOf(const mavlink::SetAttitudeTarget& message,
                                             double max_climb_mps, double max_sink_mps) {
  constexpr double kUnitTolerance = 1e-3;
  constexpr int kNeeded = mavlink::kIgnoreThrust | mavlink::kIgnoreAttitude;
  const auto& [w, x, y, z] = message.q;
  const Eigen::Quaterniond in_ned(w, x, y, z);
  const bool is_unit = std::abs(in_ned.norm() - 1) < kUnitTolerance;
  if ((message.type_mask & kNeeded) != 0 || !is_unit || !std::isfinite(message.thrust)) {
    return std::nullopt;
  }
  const Eigen::Quaterniond rotation = EnuFluFromNedFrd(in_ned.normalized());
  const Eigen::Vector3d up = rotation * Eigen::Vector3d::UnitZ();
  const double part = 2 * std::clamp<double>(message.thrust, 0, 1) - 1;
  AttitudeOrder order;
  order.acceleration = kGravity * up.head<2>() / std::max(up.z(), 0.1);
  order.climb_mps = part * (part > 0 ? max_climb_mps : max_sink_mps);
  order.yaw = HeadingOf(rotation);
  return order;
}

std::optional<SetPoint> AccelerationOrderOf(const mavlink::SetPositionTargetLocalNed& message) {
  constexpr int kOthers = mavlink::kIgnorePosition | mavlink::kIgnoreVelocity;
  if ((message.type_mask & kOthers) != kOthers ||
      (message.type_mask & mavlink::kIgnoreAcceleration) != 0) {
    return std::nullopt;
  }
  SetPoint order;
  order.acceleration = EnuFromNed({message.afx, message.afy, message.afz});
  if ((message.type_mask & mavlink::kIgnoreYaw) == 0) order.yaw = kNorth - message.yaw;
  if (!order.acceleration.allFinite() || !std::isfinite(order.yaw.value_or(0))) return std::nullopt;
  return order;
}

std::optional<FlightOrder> FlightOrderOf(const mavlink::SetPositionTargetLocalNed& message,
                                         const FlightState& state) {
  const bool is_of_body = IsOfBody(message.coordinate_frame);
  // If one axis is ignored, all three are.
  const bool has_velocity = (message.type_mask & mavlink::kIgnoreVelocity) == 0;
  const bool has_place = (message.type_mask & mavlink::kIgnorePosition) == 0 && !is_of_body;
  if (!has_velocity && !has_place) return std::nullopt;
  const Eigen::AngleAxisd turn(is_of_body ? HeadingOf(state) - kNorth : 0,
                               Eigen::Vector3d::UnitZ());
  FlightOrder order;
  if (has_velocity) {
    order.set_point.velocity = turn * EnuFromNed({message.vx, message.vy, message.vz});
  }
  if (has_place) order.set_point.place = EnuFromNed({message.x, message.y, message.z});
  if ((message.type_mask & mavlink::kIgnoreAcceleration) == 0) {
    order.set_point.acceleration = turn * EnuFromNed({message.afx, message.afy, message.afz});
  }
  if ((message.type_mask & mavlink::kIgnoreYaw) == 0) {
    order.set_point.yaw = is_of_body ? HeadingOf(state) - message.yaw : kNorth - message.yaw;
  }
  if ((message.type_mask & mavlink::kIgnoreYawRate) == 0) {
    order.turn_rate = -message.yaw_rate;
  }
  if (!order.set_point.velocity.allFinite() ||
      !order.set_point.place.value_or(Eigen::Vector3d::Zero()).allFinite() ||
      !order.set_point.acceleration.allFinite() ||
      !std::isfinite(order.set_point.yaw.value_or(0)) ||
      !std::isfinite(order.turn_rate.value_or(0))) {
    return std::nullopt;
  }
  return order;
}

}  // namespace kestrel
