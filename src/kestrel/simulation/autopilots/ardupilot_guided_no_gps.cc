// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/autopilots/ardupilot_guided_no_gps.h"

#include <algorithm>

namespace kestrel {

void ArduPilotGuidedNoGps::Handle(const mavlink::SetAttitudeTarget& message,
                                  const FlightState& state, bool is_guided) {
  if (!is_guided) return;
  const auto order = AttitudeOrderOf(message, parameters_["WP_SPD_UP"], parameters_["WP_SPD_DN"]);
  if (!order) return;
  order_ = *order;
  reported_ = state.time;
}

void ArduPilotGuidedNoGps::Start(const FlightState& state) {
  order_ = {};
  order_.yaw = HeadingOf(state);
  reported_ = state.time;
}

// Without messages it is level at the last yaw, and neither climbs nor sinks.
FlightCommand ArduPilotGuidedNoGps::Fly(const FlightState& state) {
  constexpr double kLeastTimeout_s = 0.1;
  constexpr double kClimbGain = 7;  // as of GUIDED
  const double timeout_s = std::max(parameters_["GUID_TIMEOUT"], kLeastTimeout_s);
  if (ToSeconds(state.time - reported_) > timeout_s) {
    order_.acceleration.setZero();
    order_.climb_mps = 0;
  }
  FlightCommand command;
  command.is_thrust = true;
  command.set_point.velocity << state.velocity().head<2>(), order_.climb_mps;
  command.set_point.acceleration << order_.acceleration,
      kClimbGain * (order_.climb_mps - state.velocity().z());
  command.set_point.yaw = order_.yaw;
  return command;
}

}  // namespace kestrel
