// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/autopilots/return_flight.h"

#include <algorithm>

namespace kestrel {

using Eigen::Vector2d;

ReturnFlight::ReturnFlight(AutopilotFirmware firmware, const AutopilotParameters& parameters)
    : parameters_(parameters),
      altitude_(firmware == AutopilotFirmware::kPx4 ? "RTL_RETURN_ALT" : "RTL_ALT_M"),
      speed_(firmware == AutopilotFirmware::kPx4 ? "MPC_XY_CRUISE" : "WP_SPD"),
      sink_(firmware == AutopilotFirmware::kPx4 ? "MPC_LAND_SPEED" : "LAND_SPD_MS") {}

void ReturnFlight::Start(const FlightState& state) {
  leg_ = Leg::kUp;
  from_ = state.position().head<2>();
}

double ReturnFlight::SinkAt(double height_m) const {
  constexpr double kHigh_m = 10;
  constexpr double kHigh_mps = 1.5;
  return height_m > kHigh_m ? kHigh_mps : parameters_[sink_];
}

SetPoint ReturnFlight::Fly(const FlightState& state) {
  constexpr double kNear_m = 0.5;
  constexpr double kBraking = 2.5;
  constexpr double kClimb_mps = 2.5;
  const double to_climb_m = parameters_[altitude_] - state.position().z();
  if (leg_ == Leg::kUp && to_climb_m < kNear_m) leg_ = Leg::kHome;
  if (leg_ == Leg::kHome && state.position().head<2>().norm() < kNear_m) leg_ = Leg::kDown;
  const Vector2d goal = leg_ == Leg::kUp ? from_ : Vector2d(Vector2d::Zero());
  SetPoint command;
  command.velocity.head<2>() =
      BrakingVelocity(goal - state.position().head<2>(), 1, kBraking, parameters_[speed_]);
  // If it is already higher, it stays there.
  command.velocity.z() =
      leg_ == Leg::kDown ? -SinkAt(state.position().z()) : std::clamp(to_climb_m, 0.0, kClimb_mps);
  return command;
}

}  // namespace kestrel
