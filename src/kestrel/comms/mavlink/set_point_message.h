// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "kestrel/comms/mavlink/autopilot.h"
#include "kestrel/comms/mavlink/connection.h"
#include "kestrel/comms/mavlink/messages.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/set_point.h"

namespace kestrel {

// Returns a set-point as a message in the frame LOCAL_NED: velocity (which ArduPilot's GUIDED and
// PX4's OFFBOARD treat alike) or place, acceleration and heading. A place is for PX4 only; the
// world's origin has to be that of the autopilot's local frame. Without a yaw the heading stays:
// ArduPilot, which would turn along the velocity, gets a yaw rate of zero. 'boot_ms': the present
// time on the autopilot's clock.
mavlink::SetPositionTargetLocalNed SetPointMessage(const SetPoint& set_point, AutopilotKind kind,
                                                   std::uint8_t system, std::uint8_t component,
                                                   std::uint32_t boot_ms);

// Returns a level attitude for ArduPilot's GUIDED. 'heading': clockwise from north, rad. 'thrust':
// a climb rate, 0.5 for none, 0 and 1 for the fastest down and up.
mavlink::SetAttitudeTarget LevelMessage(float heading, float thrust, std::uint8_t system,
                                        std::uint8_t component, std::uint32_t boot_ms);

// A command for an autopilot that knows its attitude only, in the world by the autopilot's heading.
struct LeanSetPoint {
  Eigen::Vector3d acceleration{0, 0, 0};  // m/s^2; upwards for PX4 only
  double climb_mps = 0;                   // for ArduPilot only
  double yaw = 0;                         // of the nose, rad from east to north
};

// Returns it as the attitude and the climb rate that ArduCopter's GUIDED_NOGPS takes.
// 'max_climb_mps', 'max_sink_mps': the autopilot's own (WP_SPD_UP, WP_SPD_DN).
mavlink::SetAttitudeTarget LeanMessage(const LeanSetPoint& set_point, double max_climb_mps,
                                       double max_sink_mps, std::uint8_t system,
                                       std::uint8_t component, std::uint32_t boot_ms);

// Returns it as the acceleration and the yaw that PX4's OFFBOARD takes without a position: one axis
// of a velocity would be refused there.
mavlink::SetPositionTargetLocalNed AccelerationMessage(const LeanSetPoint& set_point,
                                                       std::uint8_t system, std::uint8_t component,
                                                       std::uint32_t boot_ms);

// Returns the form of a set-point for a UAV that a deck carries, for ArduPilot's GUIDED: level, the
// heading, and down as fast as it may. Where it controls a velocity against the deck, it leans ever
// more, and its land detector never finds that it has landed.
mavlink::SetAttitudeTarget CarriedMessage(const SetPoint& set_point, std::uint8_t system,
                                          std::uint8_t component, std::uint32_t boot_ms);

// Sends it, in the form that suits the autopilot. False when it was not sent: it is not finite, or
// the line did not accept it.
bool SendSetPoint(const SetPoint& set_point, const Autopilot& autopilot, Time now,
                  Connection* connection);
bool SendSetPoint(const LeanSetPoint& set_point, double max_climb_mps, double max_sink_mps,
                  const Autopilot& autopilot, Time now, Connection* connection);

}  // namespace kestrel
