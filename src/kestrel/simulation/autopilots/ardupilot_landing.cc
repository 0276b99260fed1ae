// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/autopilots/ardupilot_landing.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kestrel {
namespace {

using Eigen::Vector2d;

}  // namespace

ArduPilotLanding::ArduPilotLanding(const AutopilotParameters& parameters, Announce announce)
    : parameters_(parameters), target_(parameters, std::move(announce)) {}

void ArduPilotLanding::Handle(const mavlink::LandingTarget& target, const FlightState& state) {
  target_.Handle(target, state);
}

// ArduPilot does not use this message.
void ArduPilotLanding::Handle(const mavlink::TargetRelative& /*target*/,
                              const FlightState& /*state*/) {}

void ArduPilotLanding::StartLanding(const FlightState& state) {
  path_.Start(state.position().head<2>(), state.velocity().head<2>());
  had_target_ = false;
}

SetPoint ArduPilotLanding::Land(const FlightState& state) {
  had_target_ = had_target_ || target_.is_acquired();
  ShapePath(state);
  SetPoint command;
  const Vector2d way = path_.position() - state.position().head<2>();
  command.velocity << path_.velocity() + parameters_["PSC_NE_POS_P"] * way,
      Hovers() ? 0 : ClimbRate(state);
  command.acceleration.head<2>() = path_.acceleration();
  return command;
}

// With PLND_STRICT 2 it does not descend after it has lost its target.
bool ArduPilotLanding::Hovers() const {
  constexpr int kVeryStrict = 2;
  return had_target_ && !target_.is_acquired() && parameters_["PLND_STRICT"] == kVeryStrict;
}

// Moves towards the target within the limits of acceleration and jerk; stops while there is none.
void ArduPilotLanding::ShapePath(const FlightState& state) {
  const double max_acceleration = parameters_["WP_ACC"];
  const double max_jerk = parameters_["PSC_JERK_NE"];
  const double acceleration_gain = max_jerk / max_acceleration;
  Vector2d wanted_velocity(0, 0);
  if (target_.is_acquired()) {
    constexpr int kMovingTarget = 1;
    const bool moves = (static_cast<int>(parameters_["PLND_OPTIONS"]) & kMovingTarget) != 0 &&
                       parameters_["PLND_EST_TYPE"] == 1;
    const Vector2d way = state.position().head<2>() + target_.position() - path_.position();
    wanted_velocity =
        BrakingVelocity(way, 0.5 * acceleration_gain, max_acceleration, parameters_["WP_SPD"]);
    if (moves) wanted_velocity += target_.velocity() + state.velocity().head<2>();
  } else {
    path_.MoveTo(state.position().head<2>());
  }
  path_.Step(wanted_velocity, Vector2d::Zero(), max_acceleration, max_jerk, state.step_s);
}

double ArduPilotLanding::ClimbRate(const FlightState& state) const {
  const double land_mps = parameters_["LAND_SPD_MS"];
  // The altitude is above home: without a rangefinder the ground below is unknown.
  const double to_low_m = state.position().z() - parameters_["LAND_ALT_LOW_M"];
  const double gain = parameters_["PSC_NE_POS_P"];
  const double fall_mps = to_low_m > 0 ? BrakingSpeed(to_low_m, gain, parameters_["WP_ACC"]) : 0;
  const double climb =
      -std::clamp(fall_mps, land_mps, std::max(parameters_["WP_SPD_DN"], land_mps));
  if (!target_.is_acquired()) return climb;
  const double error_m = target_.position().norm();
  const double max_error_m = parameters_["PLND_XY_DIST_MAX"];
  if (max_error_m > 0 && error_m > max_error_m) return 0;
  // Near the target it slows down, the more the farther it is beside it.
  if (target_.depth() > 0.35 && target_.depth() < 2) {
    constexpr double kAcceptableError_m = 0.15;
    constexpr double kSlowest_mps = 0.1;
    const double fastest_mps = 0.5 * land_mps;
    return std::min(-kSlowest_mps, -fastest_mps + error_m * fastest_mps / kAcceptableError_m);
  }
  return climb;
}

}  // namespace kestrel
