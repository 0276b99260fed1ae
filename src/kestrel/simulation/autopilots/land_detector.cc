// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/autopilots/land_detector.h"

#include <cmath>

namespace kestrel {
namespace {

// Time from contact to the state "landed". ArduPilot: three seconds until the throttle has come
// down and one at its lower limit (measured: 4 s). PX4: ground contact, maybe landed, landed
// (measured: 3 to 4 s).
constexpr double kArduPilotDetect_s = 4;
constexpr double kPx4Detect_s = 3.5;

// While a larger change of speed is wanted, ArduPilot's motors are not at their lower limit: its
// detector does not use horizontal speed, but a UAV that brakes against the deck that carries it
// does not idle.
bool ArduPilotSettles(const FlightState& state, const SetPoint& command) {
  constexpr double kBraking_mps = 1;
  const Eigen::Vector2d braking = command.velocity.head<2>() - state.velocity().head<2>();
  return command.velocity.z() < 0 && braking.norm() < kBraking_mps;
}

bool Px4Settles(const FlightState& state, const SetPoint& command, double max_speed_mps) {
  constexpr double kStill_mps = 0.25;
  constexpr double kSlowestDescent_mps = 0.28;  // measured
  return command.velocity.z() < -kSlowestDescent_mps &&
         state.velocity().head<2>().norm() < max_speed_mps &&
         std::abs(state.velocity().z()) < kStill_mps;
}

}  // namespace

bool LandDetector::Settles(const FlightState& state, const SetPoint& command) const {
  if (!state.is_standing) return false;
  return firmware_ == AutopilotFirmware::kPx4
             ? Px4Settles(state, command, parameters_["LNDMC_XY_VEL_MAX"])
             : ArduPilotSettles(state, command);
}

void LandDetector::Observe(const FlightState& state, const SetPoint& command) {
  is_on_ground_ = is_on_ground_ && state.is_standing;
  // Once landed, it stays landed until it lifts off.
  const bool stays = has_landed() && state.is_standing;
  settled_s_ = stays || Settles(state, command) ? settled_s_ + state.step_s : 0;
}

double LandDetector::landed_s() const {
  return settled_s_ - (firmware_ == AutopilotFirmware::kPx4 ? kPx4Detect_s : kArduPilotDetect_s);
}

}  // namespace kestrel
