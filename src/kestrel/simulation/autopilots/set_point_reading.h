// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "kestrel/comms/mavlink/messages.h"
#include "kestrel/core/poses/set_point.h"
#include "kestrel/simulation/autopilot_rules/landing_rules.h"

namespace kestrel {

// The velocity or the place in a SET_POSITION_TARGET_LOCAL_NED, in the world (ENU).
struct FlightOrder {
  SetPoint set_point;
  std::optional<double> turn_rate;  // rad/s, from east to north; with a yaw: of that yaw
};

// Returns nothing when the message has neither a velocity nor a place, or any of its values is not
// finite. In the frames MAV_FRAME_BODY_NED and BODY_OFFSET_NED, velocity and acceleration are
// rotated by the heading, and a place is not read.
std::optional<FlightOrder> FlightOrderOf(const mavlink::SetPositionTargetLocalNed& message,
                                         const FlightState& state);

// The acceleration, and the yaw, in a SET_POSITION_TARGET_LOCAL_NED that has neither a velocity nor
// a place, not of one axis; nothing: it has one, or is not finite.
std::optional<SetPoint> AccelerationOrderOf(const mavlink::SetPositionTargetLocalNed& message);

// The attitude in a SET_ATTITUDE_TARGET.
struct AttitudeOrder {
  Eigen::Vector2d acceleration{0, 0};  // by its lean, m/s^2, in the world (ENU)
  double climb_mps = 0;
  std::optional<double> yaw = std::nullopt;  // rad from east to north
};

// Returns nothing when the message has no attitude or no thrust, or one that is not valid. The
// thrust is a climb rate: 0 is the fastest sink rate, 0.5 none, 1 the fastest climb rate.
std::optional<AttitudeOrder> AttitudeOrderOf(const mavlink::SetAttitudeTarget& message,
                                             double max_climb_mps, double max_sink_mps);

// Returns the heading of a UAV, rad from east to north.
double HeadingOf(const FlightState& state);

}  // namespace kestrel
