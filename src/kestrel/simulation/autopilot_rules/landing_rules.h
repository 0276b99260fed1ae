// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include <Eigen/Core>

#include "kestrel/comms/mavlink/messages.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/core/poses/set_point.h"

namespace kestrel {

// The autopilot's state of its own flight at one step.
struct FlightState {
  Time time;                 // on the local clock
  std::int64_t boot_us = 0;  // the same instant on the autopilot's own clock
  double step_s = 0;         // since the step before
  PoseSample pose;           // the autopilot's estimate, with motion
  bool is_standing = false;  // its legs carry its weight

  const Eigen::Vector3d& position() const { return pose.world_from_body.translation; }
  const Eigen::Vector3d& velocity() const { return pose.motion->velocity_in_world; }
};

// Command for the flight of the UAV.
struct FlightCommand {
  SetPoint set_point;
  // True when the autopilot controls its velocity itself: the acceleration is then the thrust of
  // the rotors, independent of the air, and the velocity only states its purpose.
  bool is_thrust = false;
};

// MAV_SEVERITY of STATUSTEXT.
enum class Severity : std::uint8_t { kCritical = 2, kWarning = 4, kInfo = 6 };

// Sends a text to the ground station.
using Announce = std::function<void(Severity severity, const std::string& text)>;

// Precision landing of an autopilot: its belief about the target by the messages that it receives,
// and how it flies then. Internally ENU and FLU.
class LandingRules {
 public:
  virtual ~LandingRules() = default;

  virtual void Handle(const mavlink::LandingTarget& target, const FlightState& state) = 0;
  virtual void Handle(const mavlink::TargetRelative& target, const FlightState& state) = 0;

  // Called once a step, in every mode.
  virtual void Estimate(const FlightState& state) = 0;

  // Called when the landing mode begins.
  virtual void StartLanding(const FlightState& state) = 0;
  // One step of the landing mode. Returns the set-point to fly.
  virtual SetPoint Land(const FlightState& state) = 0;
};

// Returns the speed for a distance: proportional to it near by, and further away the speed that can
// still be braked with 'acceleration' (ArduPilot's square root controller).
double BrakingSpeed(double distance, double gain, double acceleration);

// The same along a horizontal vector, no faster than 'max_speed'.
Eigen::Vector2d BrakingVelocity(const Eigen::Vector2d& way, double gain, double acceleration,
                                double max_speed);

}  // namespace kestrel
