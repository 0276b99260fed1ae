// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/autopilots/px4_offboard.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/core/poses/gravity.h"
#include "kestrel/simulation/autopilots/set_point_reading.h"
#include "kestrel/simulation/vehicle/multicopter_motion.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kStream_s = 0.6;   // duration of a stream before it is trusted (measured)
constexpr double kSlowest_s = 0.5;  // longest time between two set-points of a stream
// MC_YAW_P and MC_YAWRATE_MAX as they come.
constexpr double kPx4YawGain = 2.8;
constexpr double kPx4Turn = Radians(200);
constexpr double kReaction_s = 0.3;  // delay of its failsafe after the time-out (measured)

}  // namespace

Px4Offboard::Px4Offboard(const AutopilotParameters& parameters, double thrust_error,
                         double sag_per_s, Announce announce)
    : parameters_(parameters),
      thrust_error_(thrust_error),
      sag_per_s_(sag_per_s),
      announce_(std::move(announce)),
      heading_(kPx4YawGain, kPx4Turn) {}

void Px4Offboard::Handle(const mavlink::SetPositionTargetLocalNed& message,
                         const FlightState& state, bool /*is_guided*/) {
  const std::uint8_t frame = message.coordinate_frame;
  if (frame != mavlink::kFrameLocalNed && frame != mavlink::kFrameBodyNed) {
    announce_(Severity::kCritical,
              fmt::format("SET_POSITION_TARGET_LOCAL_NED coordinate frame {} unsupported", frame));
    return;
  }
  const auto acceleration = AccelerationOrderOf(message);
  is_acceleration_ = acceleration.has_value();
  if (acceleration) {
    wanted_ = *acceleration;
    turn_rate_.reset();
    return TakeStream(state);
  }
  const auto order = FlightOrderOf(message, state);
  if (!order) return;
  wanted_ = order->set_point;
  turn_rate_ = order->turn_rate;
  TakeStream(state);
}

void Px4Offboard::TakeStream(const FlightState& state) {
  if (!stream_begin_ || SilentFor(state) > kSlowest_s) stream_begin_ = state.time;
  reported_ = state.time;
}

double Px4Offboard::SilentFor(const FlightState& state) const {
  return stream_begin_ ? ToSeconds(state.time - reported_)
                       : std::numeric_limits<double>::infinity();
}

bool Px4Offboard::IsAvailable(const FlightState& state) const {
  return SilentFor(state) < kSlowest_s && ToSeconds(reported_ - *stream_begin_) >= kStream_s;
}

void Px4Offboard::Start(const FlightState& state) {
  started_ = state.time;
  heading_.Reset();
  integral_.setZero();
  change_.setZero();
  last_velocity_ = state.velocity();
}

// The velocity to the place, if there is one, and the one that is fed forward.
Vector3d Px4Offboard::WantedVelocity(const FlightState& state) const {
  if (!wanted_.place) return wanted_.velocity;
  const Vector3d gain(parameters_["MPC_XY_P"], parameters_["MPC_XY_P"], parameters_["MPC_Z_P"]);
  return wanted_.velocity + gain.cwiseProduct(*wanted_.place - state.position());
}

Vector3d Px4Offboard::WithinLimits(const Vector3d& velocity) const {
  const double speed = velocity.head<2>().norm();
  const double most = parameters_["MPC_XY_VEL_MAX"];
  Vector3d limited = velocity;
  if (speed > most) limited.head<2>() *= most / speed;
  limited.z() =
      std::clamp(limited.z(), -parameters_["MPC_Z_VEL_MAX_DN"], parameters_["MPC_Z_VEL_MAX_UP"]);
  return limited;
}

// It flies by the last set-point for as long as the mode lasts.
FlightCommand Px4Offboard::Fly(const FlightState& state) {
  if (is_acceleration_) return Accelerate(state);
  FlightCommand command;
  command.is_thrust = true;
  command.set_point.velocity = WithinLimits(WantedVelocity(state));
  command.set_point.acceleration =
      wanted_.acceleration + ControlVelocity(state, command.set_point.velocity);
  if (wanted_.yaw) {
    command.set_point.yaw = heading_.Step(*wanted_.yaw, turn_rate_.value_or(0), state);
  } else {
    heading_.Reset();
    if (turn_rate_) command.set_point.yaw = HeadingOf(state) + *turn_rate_;
  }
  return command;
}

// Lean and thrust are made of the acceleration, by its own idea of the thrust that hovers.
FlightCommand Px4Offboard::Accelerate(const FlightState& state) {
  const Vector3d weight = kGravity * Vector3d::UnitZ();
  FlightCommand command;
  command.is_thrust = true;
  const double thrust = 1 + thrust_error_ - sag_per_s_ * ToSeconds(state.time - started_);
  command.set_point.acceleration = thrust * (wanted_.acceleration + weight) - weight;
  command.set_point.velocity = state.velocity();
  command.set_point.velocity.z() += wanted_.acceleration.z();
  if (wanted_.yaw) {
    command.set_point.yaw = heading_.Step(*wanted_.yaw, 0, state);
  } else {
    heading_.Reset();
  }
  return command;
}

// P, I and D, as an acceleration; the integral stops at the tilt limit.
Vector3d Px4Offboard::ControlVelocity(const FlightState& state, const Vector3d& velocity) {
  constexpr double kFilter_s = 0.03;  // time constant for the derivative
  const auto gains = [this](const char* horizontal, const char* vertical) {
    return Vector3d(parameters_[horizontal], parameters_[horizontal], parameters_[vertical]);
  };
  const Vector3d error = velocity - state.velocity();
  const double blend = std::min(1.0, state.step_s / kFilter_s);
  change_ += blend * ((state.velocity() - last_velocity_) / state.step_s - change_);
  last_velocity_ = state.velocity();
  Vector3d control = gains("MPC_XY_VEL_P_ACC", "MPC_Z_VEL_P_ACC").cwiseProduct(error) + integral_ -
                     gains("MPC_XY_VEL_D_ACC", "MPC_Z_VEL_D_ACC").cwiseProduct(change_);
  const double most = kGravity * std::tan(Radians(parameters_["MPC_TILTMAX_AIR"]));
  if (state.is_standing) {
    integral_.setZero();
  } else if ((control + wanted_.acceleration).head<2>().norm() < most) {
    integral_ += state.step_s * gains("MPC_XY_VEL_I_ACC", "MPC_Z_VEL_I_ACC").cwiseProduct(error);
  }
  return control;
}

std::optional<FlightMode> Px4Offboard::LossAction(const FlightState& state) const {
  if (SilentFor(state) < parameters_["COM_OF_LOSS_T"] + kReaction_s) return std::nullopt;
  switch (static_cast<int>(parameters_["COM_OBL_RC_ACT"])) {
    case 3:
      return FlightMode::kReturn;
    case 4:
    case 6:  // would stop the motors, which is not modelled
    case 7:
      return FlightMode::kLand;
    case 5:
      return FlightMode::kHold;
    default:
      break;
  }
  // Without a transmitter it cannot enter a mode of the pilot.
  switch (static_cast<int>(parameters_["NAV_RCL_ACT"])) {
    case 1:
      return FlightMode::kHold;
    case 2:
      return FlightMode::kReturn;
    case 3:
      return FlightMode::kLand;
    default:
      return std::nullopt;
  }
}

}  // namespace kestrel
