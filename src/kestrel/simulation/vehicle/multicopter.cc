// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/vehicle/multicopter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "kestrel/core/poses/gravity.h"

namespace kestrel {
namespace {

using Eigen::Vector3d;

constexpr double kDragLag_s = 0.2;
constexpr double kMaxVertical = 5;  // m/s^2; the rotors neither stop nor reach double power

// Returns 'vector', with its horizontal and its vertical part limited to these lengths.
Vector3d Limited(const Vector3d& vector, double horizontal, double vertical) {
  const double length = std::hypot(vector.x(), vector.y());
  const double scale = length > horizontal ? horizontal / length : 1;
  return {scale * vector.x(), scale * vector.y(), std::clamp(vector.z(), -vertical, vertical)};
}

}  // namespace

Multicopter::Multicopter(const MulticopterOptions& options, const Vector3d& position,
                         double heading, const Vector3d& velocity)
    : options_(options),
      position_(position),
      velocity_(velocity),
      thrust_(kGravity * Vector3d::UnitZ()),
      lagging_(thrust_),
      heading_(heading) {}

void Multicopter::Step(const SetPoint& command, const Vector3d& wind, double seconds) {
  Move(WantedThrust(command), wind, seconds);
  Turn(command.yaw, seconds);
}

void Multicopter::StepByThrust(const Vector3d& acceleration, std::optional<double> yaw,
                               const Vector3d& wind, double seconds) {
  const Vector3d limited = Limited(acceleration, options_.max_acceleration, kMaxVertical);
  Move(WithinTilt(limited + kGravity * Vector3d::UnitZ()), wind, seconds);
  Turn(yaw, seconds);
}

void Multicopter::Move(const Vector3d& wanted_thrust, const Vector3d& wind, double seconds) {
  const double lag = 1 - std::exp(-seconds / options_.attitude_lag_s);
  lagging_ += lag * (wanted_thrust - lagging_);
  thrust_ += lag * (lagging_ - thrust_);
  const Vector3d drag = options_.drag * (wind - velocity_);
  felt_drag_ += (1 - std::exp(-seconds / kDragLag_s)) * (drag - felt_drag_);
  const Vector3d acceleration = thrust_ + drag - kGravity * Vector3d::UnitZ();
  position_ += seconds * (velocity_ + 0.5 * seconds * acceleration);
  velocity_ += seconds * acceleration;
}

void Multicopter::Turn(std::optional<double> yaw, double seconds) {
  if (!yaw) return;
  const double most = seconds * options_.max_turn_dps * std::numbers::pi / 180;
  heading_ += std::clamp(std::remainder(*yaw - heading_, 2 * std::numbers::pi), -most, most);
}

Vector3d Multicopter::WantedThrust(const SetPoint& command) const {
  // Limited together: the acceleration must not exceed the speed limit either.
  const Vector3d velocity =
      Limited(command.velocity + command.acceleration / options_.velocity_gain,
              options_.max_speed_mps, options_.max_climb_mps);
  const Vector3d wanted = Limited(options_.velocity_gain * (velocity - velocity_),
                                  options_.max_acceleration, kMaxVertical);
  return WithinTilt(wanted - felt_drag_ + kGravity * Vector3d::UnitZ());
}

Vector3d Multicopter::WithinTilt(const Vector3d& thrust) const {
  const double max_tilt = options_.max_tilt_deg * std::numbers::pi / 180;
  return Limited(thrust, std::tan(max_tilt) * thrust.z(), thrust.z());
}

RigidTransform Multicopter::world_from_body() const {
  // As ArduPilot composes it: the heading first, then the shortest rotation to the thrust.
  const Vector3d up = thrust_.normalized();
  const Eigen::Quaterniond lean(1 + up.z(), -up.y(), up.x(), 0);
  return {lean.normalized() * Eigen::AngleAxisd(heading_, Vector3d::UnitZ()), position_};
}

}  // namespace kestrel
