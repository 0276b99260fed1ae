// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "kestrel/core/geometry/angles.h"
#include "kestrel/core/poses/gravity.h"
#include "kestrel/simulation/autopilot_rules/landing_rules.h"

namespace kestrel {

// Errors of an attitude that neither velocity nor position corrects: an acceleration that lasts is
// taken for tilt, and the compass may turn. What is flown by that attitude is wrong by the same.
class AttitudeError {
 public:
  // 'memory_s': time in which an acceleration is taken for tilt.
  explicit AttitudeError(double memory_s) : memory_s_(memory_s) {}

  // One step, in which the UAV has accelerated (world, m/s^2).
  void Step(double seconds, const Eigen::Vector3d& acceleration, bool has_position) {
    constexpr double kAided_s = 2;
    const double memory_s = has_position ? kAided_s : memory_s_;
    const Eigen::Vector2d taken = has_position ? Eigen::Vector2d(0, 0) : acceleration.head<2>();
    tilt_ += seconds / memory_s * (taken - tilt_);
  }
  void set_turn(double turn) { turn_ = turn; }  // of its heading, rad

  Eigen::Quaterniond Estimate(const Eigen::Quaterniond& world_from_body) const {
    const Eigen::Vector3d up(tilt_.x(), tilt_.y(), kGravity);
    const Eigen::AngleAxisd turn(turn_, Eigen::Vector3d::UnitZ());
    return turn * Eigen::Quaterniond::FromTwoVectors(up, Eigen::Vector3d::UnitZ()) *
           world_from_body;
  }
  // Makes of a command by its attitude what truly happens.
  void Apply(FlightCommand* command) const {
    auto acceleration = command->set_point.acceleration.head<2>();
    acceleration = Eigen::Rotation2Dd(-turn_) * Eigen::Vector2d(acceleration) + tilt_;
    if (command->set_point.yaw) *command->set_point.yaw -= turn_;
  }
  double tilt() const { return tilt_.norm() / kGravity; }  // rad

 private:
  double memory_s_;
  Eigen::Vector2d tilt_{0, 0};  // as an acceleration, m/s^2
  double turn_ = 0;
};

}  // namespace kestrel
