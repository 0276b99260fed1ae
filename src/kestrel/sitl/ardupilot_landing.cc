// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/sitl/ardupilot_landing.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kestrel {
namespace {

using Eigen::Vector2d;

// From contact until the motors stop: three seconds until the throttle has come down, one at its
// lower limit (measured: 4 s).
constexpr double kSettle_s = 4;
// While it wants to change its speed by more, its motors are not at their lower limit.
constexpr double kBraking_mps = 1;

}  // namespace

ArduPilotLanding::ArduPilotLanding(const AutopilotParameters& parameters, Announce announce)
    : parameters_(parameters), target_(parameters, std::move(announce)) {}

void ArduPilotLanding::Handle(const mavlink::LandingTarget& target, const FlightState& state) {
  target_.Handle(target, state);
}

// ArduPilot does not know this message.
void ArduPilotLanding::Handle(const mavlink::TargetRelative& /*target*/,
                              const FlightState& /*state*/) {}

void ArduPilotLanding::StartLanding(const FlightState& state) {
  path_position_ = state.position().head<2>();
  path_velocity_ = state.velocity().head<2>();
  path_acceleration_.setZero();
  had_target_ = false;
  settled_s_ = 0;
}

SetPoint ArduPilotLanding::Land(const FlightState& state) {
  had_target_ = had_target_ || target_.is_acquired();
  ShapePath(state);
  SetPoint command;
  const Vector2d way = path_position_ - state.position().head<2>();
  command.velocity << path_velocity_ + parameters_["PSC_NE_POS_P"] * way,
      Hovers() ? 0 : ClimbRate(state);
  command.acceleration.head<2>() = path_acceleration_;
  DetectLanding(state, command);
  return command;
}

// With PLND_STRICT 2 it does not go down without the target that it had.
bool ArduPilotLanding::Hovers() const {
  constexpr int kVeryStrict = 2;
  return had_target_ && !target_.is_acquired() && parameters_["PLND_STRICT"] == kVeryStrict;
}

// Towards the target within the limits of acceleration and jerk; to a stop while there is none.
void ArduPilotLanding::ShapePath(const FlightState& state) {
  const double max_acceleration = parameters_["WP_ACC"];
  const double max_jerk = parameters_["PSC_JERK_NE"];
  const double acceleration_gain = max_jerk / max_acceleration;
  Vector2d wanted_velocity(0, 0);
  if (target_.is_acquired()) {
    constexpr int kMovingTarget = 1;
    const bool moves = (static_cast<int>(parameters_["PLND_OPTIONS"]) & kMovingTarget) != 0 &&
                       parameters_["PLND_EST_TYPE"] == 1;
    const Vector2d way = state.position().head<2>() + target_.position() - path_position_;
    wanted_velocity =
        BrakingVelocity(way, 0.5 * acceleration_gain, max_acceleration, parameters_["WP_SPD"]);
    if (moves) wanted_velocity += target_.velocity() + state.velocity().head<2>();
  } else {
    path_position_ = state.position().head<2>();
  }
  const Vector2d wanted_acceleration = BrakingVelocity(
      wanted_velocity - path_velocity_, acceleration_gain, max_jerk, max_acceleration);
  const Vector2d change = wanted_acceleration - path_acceleration_;
  const double max_change = max_jerk * state.step_s;
  path_acceleration_ += std::min(1.0, max_change / std::max(change.norm(), max_change)) * change;
  path_position_ += state.step_s * (path_velocity_ + 0.5 * state.step_s * path_acceleration_);
  path_velocity_ += state.step_s * path_acceleration_;
}

double ArduPilotLanding::ClimbRate(const FlightState& state) const {
  const double land_mps = parameters_["LAND_SPD_MS"];
  // Altitude is above home: without a rangefinder it knows nothing of what is below.
  const double to_low_m = state.position().z() - 0.01 * parameters_["LAND_ALT_LOW"];
  const double gain = parameters_["PSC_NE_POS_P"];
  const double fall_mps = to_low_m > 0 ? BrakingSpeed(to_low_m, gain, parameters_["WP_ACC"]) : 0;
  const double climb =
      -std::clamp(fall_mps, land_mps, std::max(parameters_["WP_SPD_DN"], land_mps));
  if (!target_.is_acquired()) return climb;
  const double error_m = target_.position().norm();
  const double max_error_m = parameters_["PLND_XY_DIST_MAX"];
  if (max_error_m > 0 && error_m > max_error_m) return 0;
  // Near the target it slows down, the more the further it is beside it.
  if (target_.depth() > 0.35 && target_.depth() < 2) {
    constexpr double kAcceptableError_m = 0.15;
    constexpr double kSlowest_mps = 0.1;
    const double fastest_mps = 0.5 * land_mps;
    return std::min(-kSlowest_mps, -fastest_mps + error_m * fastest_mps / kAcceptableError_m);
  }
  return climb;
}

// Its detector has no horizontal speed in it; but a UAV that brakes against the deck that carries
// it along does not idle.
void ArduPilotLanding::DetectLanding(const FlightState& state, const SetPoint& command) {
  const Vector2d braking = command.velocity.head<2>() - state.velocity().head<2>();
  const bool settles =
      state.is_standing && command.velocity.z() < 0 && braking.norm() < kBraking_mps;
  settled_s_ = settles ? settled_s_ + state.step_s : 0;
}

bool ArduPilotLanding::disarms() const { return settled_s_ >= kSettle_s; }

}  // namespace kestrel
