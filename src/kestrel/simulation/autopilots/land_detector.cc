// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/autopilots/land_detector.h"

#include <cmath>

#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

// For so long all has to hold. PX4: ground contact, maybe landed, landed, a third of it each.
constexpr double kSettle_s = 1;
constexpr double kContactPart = 1.0 / 3;

}  // namespace

LandDetector::LandDetector(AutopilotFirmware firmware, const AutopilotParameters& parameters)
    : firmware_(firmware), parameters_(parameters), demand_(firmware, parameters) {}

void LandDetector::Observe(const FlightState& state, const FlightCommand& command) {
  demand_.Observe(state, command);
  ObserveAcceleration(state);
  if (!state.is_standing) {
    is_on_ground_ = false;
    settled_s_ = 0;
    landed_s_ = -1;
  } else if (landed_s_ >= 0) {
    landed_s_ += state.step_s;  // once landed, it stays landed until it lifts off
  } else {
    const bool settles = firmware_ == AutopilotFirmware::kPx4 ? Px4Settles(state, command)
                                                              : ArduPilotSettles(state, command);
    settled_s_ = settles ? settled_s_ + state.step_s : 0;
    if (settled_s_ >= kSettle_s) landed_s_ = 0;
  }
}

void LandDetector::ObserveAcceleration(const FlightState& state) {
  constexpr double kCutoff_hz = 1;
  if (!(state.step_s > 0)) return;
  const double part = 1 - std::exp(-2 * kPi * kCutoff_hz * state.step_s);
  acceleration_ += part * ((state.velocity() - last_velocity_) / state.step_s - acceleration_);
  last_velocity_ = state.velocity();
}

// update_land_detector of ArduCopter: rotors at their lower limit, with the mix that favours the
// throttle; no large lean commanded, in any mode; no acceleration, and no fast climb. A horizontal
// speed does not matter.
bool LandDetector::ArduPilotSettles(const FlightState& state, const FlightCommand& command) const {
  constexpr double kLean_deg = 15;
  constexpr double kAcceleration = 1;
  constexpr double kClimb_mps = 1;
  const bool is_commanded_down = command.set_point.velocity.z() < 0;
  return demand_.throttle() <= 0 && is_commanded_down && demand_.lean() <= Radians(kLean_deg) &&
         acceleration_.norm() <= kAcceleration && std::abs(state.velocity().z()) < kClimb_mps;
}

// MulticopterLandDetector of PX4, with its estimate of the hover thrust: ground contact, after
// which it stops the rotors by itself.
bool LandDetector::Px4Settles(const FlightState& state, const FlightCommand& command) const {
  constexpr double kDescentPart = 1.1;
  constexpr double kLowThrottle = 0.6;
  const double still_mps = parameters_["LNDMC_Z_VEL_MAX"];
  const bool has_contact = settled_s_ >= kContactPart * kSettle_s;
  const bool is_commanded_down = command.set_point.velocity.z() <= -kDescentPart * still_mps;
  return is_commanded_down && (has_contact || demand_.throttle() <= kLowThrottle) &&
         state.velocity().head<2>().norm() < parameters_["LNDMC_XY_VEL_MAX"] &&
         std::abs(state.velocity().z()) < still_mps;
}

}  // namespace kestrel
