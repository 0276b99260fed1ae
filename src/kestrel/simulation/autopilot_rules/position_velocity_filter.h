// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

namespace kestrel {

// Kalman filter of one axis: position and velocity of a target relative to a body whose changes of
// velocity are measured. The estimator of the simulated autopilots (ArduPilot's PosVelEKF).
class PositionVelocityFilter {
 public:
  void Start(double position, double position_variance, double velocity, double velocity_variance) {
    position_ = position;
    velocity_ = velocity;
    position_variance_ = position_variance;
    covariance_ = 0;
    velocity_variance_ = velocity_variance;
  }

  // Predicts over 'seconds' with a 'velocity_change' of standard deviation 'noise'.
  void Predict(double seconds, double velocity_change, double noise) {
    position_ += seconds * velocity_;
    velocity_ += velocity_change;
    position_variance_ += seconds * (2 * covariance_ + seconds * velocity_variance_);
    covariance_ += seconds * velocity_variance_;
    velocity_variance_ += noise * noise;
  }

  // Returns the squared innovation divided by its variance.
  double InnovationRatio(double position, double variance) const {
    const double innovation = position - position_;
    return innovation * innovation / (position_variance_ + variance);
  }

  void Fuse(double position, double variance) {
    const double innovation = position - position_;
    const double total = position_variance_ + variance;
    const double position_gain = position_variance_ / total;
    const double velocity_gain = covariance_ / total;
    position_ += position_gain * innovation;
    velocity_ += velocity_gain * innovation;
    velocity_variance_ -= velocity_gain * covariance_;
    covariance_ *= 1 - position_gain;
    position_variance_ *= 1 - position_gain;
  }

  double position() const { return position_; }
  double velocity() const { return velocity_; }

 private:
  double position_ = 0;
  double velocity_ = 0;
  double position_variance_ = 1;
  double covariance_ = 0;  // covariance of position and velocity
  double velocity_variance_ = 1;
};

}  // namespace kestrel
