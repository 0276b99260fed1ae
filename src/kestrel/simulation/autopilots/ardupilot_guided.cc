// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/autopilots/ardupilot_guided.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/core/poses/gravity.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;
// ATC_ANG_YAW_P and ATC_SLEW_YAW as they come.
constexpr double kArduPilotYawGain = 4.5;
constexpr double kArduPilotTurn = Radians(60);

// As an acceleration per velocity error: a cascade of velocity, acceleration and throttle.
constexpr double kClimbGain = 7;

using Vector1d = ShapedPath<1>::Vector;

bool IsFrameOfGuided(std::uint8_t frame) {
  constexpr std::array<std::uint8_t, 4> kFrames = {
      mavlink::kFrameLocalNed, mavlink::kFrameLocalOffsetNed, mavlink::kFrameBodyNed,
      mavlink::kFrameBodyOffsetNed};
  return std::ranges::find(kFrames, frame) != kFrames.end();
}

}  // namespace

ArduPilotGuided::ArduPilotGuided(const AutopilotParameters& parameters)
    : parameters_(parameters), heading_(kArduPilotYawGain, kArduPilotTurn) {}

// A set-point that it does not accept stops it.
void ArduPilotGuided::Handle(const mavlink::SetPositionTargetLocalNed& message,
                             const FlightState& state, bool is_guided) {
  constexpr double kFastest_mps = 1000;
  if (!is_guided) return;
  if (std::exchange(attitude_, std::nullopt)) Start(state);
  reported_.reset();
  const bool has_place = (message.type_mask & mavlink::kIgnorePosition) != mavlink::kIgnorePosition;
  if (!IsFrameOfGuided(message.coordinate_frame) || has_place) return;
  const auto order = FlightOrderOf(message, state);
  if (!order || order->set_point.velocity.norm() > kFastest_mps) return;
  wanted_ = order->set_point;
  turn_rate_ = order->turn_rate;
  reported_ = state.time;
}

// A message that it does not accept stops it, as above.
void ArduPilotGuided::Handle(const mavlink::SetAttitudeTarget& message, const FlightState& state,
                             bool is_guided) {
  if (!is_guided) return;
  attitude_ = AttitudeOrderOf(message, parameters_["WP_SPD_UP"], parameters_["WP_SPD_DN"]);
  reported_.reset();
  if (attitude_) {
    reported_ = state.time;
  } else {
    Start(state);
  }
}

void ArduPilotGuided::Start(const FlightState& state) {
  reported_.reset();
  attitude_.reset();
  heading_.Reset();
  limit_ = {};
  integral_.setZero();
  derivative_.setZero();
  last_error_.reset();
  horizontal_.Start(state.position().head<2>(), state.velocity().head<2>());
  vertical_.Start(state.position().tail<1>(), state.velocity().tail<1>());
}

FlightCommand ArduPilotGuided::Fly(const FlightState& state) {
  constexpr double kLeastTimeout_s = 0.1;
  const double timeout_s = std::max(parameters_["GUID_TIMEOUT"], kLeastTimeout_s);
  if (reported_ && ToSeconds(state.time - *reported_) > timeout_s) reported_.reset();
  if (attitude_) return FlyAttitude(state);
  if (!reported_) {
    wanted_ = {};
    turn_rate_ = 0;
  }
  Follow(state);
  FlightCommand command;
  command.is_thrust = true;
  const Vector2d way = horizontal_.position() - state.position().head<2>();
  const double climb = vertical_.position().x() - state.position().z();
  command.set_point.velocity << horizontal_.velocity() + parameters_["PSC_NE_POS_P"] * way,
      vertical_.velocity().x() + parameters_["PSC_D_POS_P"] * climb;
  const Eigen::Vector3d error = command.set_point.velocity - state.velocity();
  command.set_point.acceleration << ControlVelocity(state, way, error.head<2>()),
      vertical_.acceleration().x() + kClimbGain * error.z();
  command.set_point.yaw = Heading(state);
  return command;
}

// A yaw that turns is turned on between the messages.
std::optional<double> ArduPilotGuided::Heading(const FlightState& state) {
  if (wanted_.yaw) {
    const double rate = turn_rate_.value_or(0);
    *wanted_.yaw += rate * state.step_s;
    return heading_.Step(*wanted_.yaw, rate, state);
  }
  heading_.Reset();
  if (turn_rate_) {
    if (*turn_rate_ == 0) return std::nullopt;
    return HeadingOf(state) + *turn_rate_;  // a second ahead
  }
  // With WP_YAW_BEHAVIOR the heading follows the velocity.
  if (wanted_.velocity.head<2>().norm() <= 1) return std::nullopt;
  return std::atan2(wanted_.velocity.y(), wanted_.velocity.x());
}

// Without messages it is level, and neither climbs nor sinks.
FlightCommand ArduPilotGuided::FlyAttitude(const FlightState& state) {
  if (!reported_) *attitude_ = {};
  FlightCommand command;
  command.is_thrust = true;
  command.set_point.velocity = state.velocity();
  command.set_point.velocity.z() = attitude_->climb_mps;
  command.set_point.acceleration << attitude_->acceleration,
      kClimbGain * (attitude_->climb_mps - state.velocity().z());
  command.set_point.yaw = attitude_->yaw;
  return command;
}

// P, I and D with the path's acceleration. At the tilt limit the integral does not grow, and the
// path does not run away.
Vector2d ArduPilotGuided::ControlVelocity(const FlightState& state, const Vector2d& way,
                                          const Vector2d& error) {
  constexpr double kFilter_s = 0.03;  // time constant for the derivative, 5 Hz
  constexpr double kMaxIntegral = 10;
  if (last_error_) {
    const double blend = std::min(1.0, state.step_s / kFilter_s);
    derivative_ += blend * ((error - *last_error_) / state.step_s - derivative_);
  }
  last_error_ = error;
  Vector2d wanted = horizontal_.acceleration() + parameters_["PSC_NE_VEL_P"] * error + integral_ +
                    parameters_["PSC_NE_VEL_D"] * derivative_;
  const bool is_limited =
      wanted.norm() > kGravity * std::tan(Radians(parameters_["ATC_ANGLE_MAX"]));
  limit_ = {is_limited ? wanted : Vector2d(0, 0), way, error};
  if (!is_limited || integral_.dot(error) < 0) {
    integral_ += state.step_s * parameters_["PSC_NE_VEL_I"] * error;
  }
  const double size = integral_.norm();
  if (size > kMaxIntegral) integral_ *= kMaxIntegral / size;
  return wanted;
}

void ArduPilotGuided::Follow(const FlightState& state) {
  horizontal_.Step(wanted_.velocity.head<2>(), wanted_.acceleration.head<2>(),
                   parameters_["WP_ACC"], parameters_["PSC_JERK_NE"], state.step_s, limit_);
  vertical_.Step(Vector1d(wanted_.velocity.z()), Vector1d(wanted_.acceleration.z()),
                 parameters_["WP_ACC_Z"], parameters_["PSC_JERK_D"], state.step_s);
  if (!state.is_standing) return;
  // Rotors at their lower limit hold the path's height.
  vertical_.MoveTo(state.position().tail<1>());
}

}  // namespace kestrel
