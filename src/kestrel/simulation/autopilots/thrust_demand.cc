// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/autopilots/thrust_demand.h"

#include <algorithm>
#include <cmath>

#include "kestrel/core/geometry/angles.h"
#include "kestrel/core/poses/gravity.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;

// ArduPilot's vertical control is a cascade, velocity to acceleration to throttle. Its default
// gains come to these, as an acceleration per velocity error of a UAV that does not move.
constexpr double kArduPilotClimbP = 7;
constexpr double kArduPilotClimbI = 14;

}  // namespace

ThrustDemand::ThrustDemand(AutopilotFirmware firmware, const AutopilotParameters& parameters) {
  if (firmware == AutopilotFirmware::kPx4) {
    horizontal_ = {parameters["MPC_XY_VEL_P_ACC"], parameters["MPC_XY_VEL_I_ACC"]};
    vertical_ = {parameters["MPC_Z_VEL_P_ACC"], parameters["MPC_Z_VEL_I_ACC"]};
    max_lean_ = Radians(parameters["MPC_TILTMAX_AIR"]);
  } else {
    horizontal_ = {parameters["PSC_NE_VEL_P"], parameters["PSC_NE_VEL_I"]};
    vertical_ = {kArduPilotClimbP, kArduPilotClimbI};
    max_lean_ = Radians(parameters["ATC_ANGLE_MAX"]);
  }
}

// In the air the motion follows the control: nothing winds up.
void ThrustDemand::Observe(const FlightState& state, const FlightCommand& command) {
  if (!state.is_standing) {
    horizontal_integral_.setZero();
    vertical_integral_ = 0;
  }
  ObserveHorizontal(state, command);
  ObserveVertical(state, command.set_point);
}

void ThrustDemand::ObserveHorizontal(const FlightState& state, const FlightCommand& command) {
  Vector2d wanted = command.set_point.acceleration.head<2>();
  const double most = kGravity * std::tan(max_lean_);
  if (!command.is_thrust) {
    const Vector2d error = (command.set_point.velocity - state.velocity()).head<2>();
    wanted += horizontal_.p * error + horizontal_integral_;
    const bool grows = wanted.norm() < most || horizontal_integral_.dot(error) < 0;
    if (grows) horizontal_integral_ += state.step_s * horizontal_.i * error;
  }
  lean_ = std::min(std::atan(wanted.norm() / kGravity), max_lean_);
}

void ThrustDemand::ObserveVertical(const FlightState& state, const SetPoint& command) {
  const double error = command.velocity.z() - state.velocity().z();
  const double wanted = kGravity + vertical_.p * error + vertical_integral_;
  if (wanted > 0 || error > 0) vertical_integral_ += state.step_s * vertical_.i * error;
  throttle_ = std::max(wanted / kGravity, 0.0);
}

}  // namespace kestrel
