// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include "kestrel/comms/autopilot_rules/landing_rules.h"
#include "kestrel/comms/mavlink/messages.h"
#include "kestrel/core/poses/set_point.h"

namespace kestrel {

// What SET_POSITION_TARGET_LOCAL_NED says of a velocity, in the world (ENU).
struct VelocityOrder {
  SetPoint set_point;
  std::optional<double> turn_rate;  // rad/s, from east to north
};

// Nothing where the message has no velocity, or anything of it is not finite. Velocity and
// acceleration of the frames MAV_FRAME_BODY_NED and BODY_OFFSET_NED are turned by the heading.
std::optional<VelocityOrder> VelocityOrderOf(const mavlink::SetPositionTargetLocalNed& message,
                                             const FlightState& state);

// The heading of a UAV, rad from east to north.
double HeadingOf(const FlightState& state);

}  // namespace kestrel
