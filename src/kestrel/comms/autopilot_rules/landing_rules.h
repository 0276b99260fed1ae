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

// What an autopilot knows of its own flight at one step.
struct FlightState {
  Time time;                 // on the local clock
  std::int64_t boot_us = 0;  // the same instant on the autopilot's own clock
  double step_s = 0;         // since the step before
  PoseSample pose;           // its estimate, with motion
  bool is_standing = false;  // its weight is on its feet

  const Eigen::Vector3d& position() const { return pose.world_from_body.translation; }
  const Eigen::Vector3d& velocity() const { return pose.motion->velocity_in_world; }
};

// How the UAV is to fly.
struct FlightCommand {
  SetPoint set_point;
  // The autopilot controls its velocity by itself: the acceleration is what the rotors are to give,
  // whatever the air does, and the velocity only says what it is for.
  bool is_thrust = false;
};

// MAV_SEVERITY of STATUSTEXT.
enum class Severity : std::uint8_t { kCritical = 2, kWarning = 4, kInfo = 6 };

// Says something to the ground station.
using Announce = std::function<void(Severity severity, const std::string& text)>;

// How an autopilot lands by the targets that it is told: what it believes of them and what it does
// then. Internally ENU and FLU.
class LandingRules {
 public:
  virtual ~LandingRules() = default;

  virtual void Handle(const mavlink::LandingTarget& target, const FlightState& state) = 0;
  virtual void Handle(const mavlink::TargetRelative& target, const FlightState& state) = 0;

  // Once a step, in whatever mode it flies.
  virtual void Estimate(const FlightState& state) = 0;

  // The landing mode begins.
  virtual void StartLanding(const FlightState& state) = 0;
  // One step of it: how to fly.
  virtual SetPoint Land(const FlightState& state) = 0;
};

// Speed for a distance: in proportion to it near by, and further away what can still be braked with
// 'acceleration' (ArduPilot's square root controller).
double BrakingSpeed(double distance, double gain, double acceleration);

// The same along a horizontal vector, no faster than 'max_speed'.
Eigen::Vector2d BrakingVelocity(const Eigen::Vector2d& way, double gain, double acceleration,
                                double max_speed);

}  // namespace kestrel
