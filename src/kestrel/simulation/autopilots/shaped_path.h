// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include <Eigen/Core>

#include "kestrel/simulation/autopilot_rules/landing_rules.h"

namespace kestrel {

// A position that moves smoothly, whatever velocity is wanted: ArduPilot's shaping within limits of
// acceleration and jerk.
template <int kDimensions>
class ShapedPath {
 public:
  using Vector = Eigen::Matrix<double, kDimensions, 1>;

  void Start(const Vector& position, const Vector& velocity) {
    position_ = position;
    velocity_ = velocity;
    acceleration_.setZero();
  }
  // Moves to another position at the same velocity.
  void MoveTo(const Vector& position) { position_ = position; }

  // Limits of the UAV that follows: the path does not run away from it.
  struct Limit {
    Vector direction = Vector::Zero();       // in which it cannot accelerate more; zero: it can
    Vector way = Vector::Zero();             // from the UAV to the path, m
    Vector velocity_error = Vector::Zero();  // velocity error of the UAV, m/s
  };

  // 'feed_forward': wanted acceleration in addition to the velocity. 'max_acceleration' limits only
  // the correction of the velocity.
  void Step(const Vector& wanted_velocity, const Vector& feed_forward, double max_acceleration,
            double max_jerk, double seconds, const Limit& limit = {}) {
    const Vector error = wanted_velocity - velocity_;
    const double distance = error.norm();
    Vector wanted = feed_forward;
    if (distance > 0) {
      const double correction = BrakingSpeed(distance, max_jerk / max_acceleration, max_jerk);
      wanted += std::min(correction, max_acceleration) / distance * error;
    }
    const Vector change = wanted - acceleration_;
    const double max_change = max_jerk * seconds;
    acceleration_ += std::min(1.0, max_change / std::max(change.norm(), max_change)) * change;
    const auto is_beyond = [&limit](const Vector& step, const Vector& off) {
      return step.dot(limit.direction) > 0 && off.dot(limit.direction) > 0;
    };
    const Vector step = seconds * (velocity_ + 0.5 * seconds * acceleration_);
    if (!is_beyond(step, limit.way)) position_ += step;
    const Vector gain = seconds * acceleration_;
    const bool would_slow_down = velocity_.dot(limit.direction) < 0;
    if (would_slow_down || !is_beyond(gain, limit.velocity_error)) velocity_ += gain;
  }

  const Vector& position() const { return position_; }
  const Vector& velocity() const { return velocity_; }
  const Vector& acceleration() const { return acceleration_; }

 private:
  Vector position_ = Vector::Zero();
  Vector velocity_ = Vector::Zero();
  Vector acceleration_ = Vector::Zero();
};

}  // namespace kestrel
