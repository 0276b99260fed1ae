// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include <Eigen/Core>

namespace kestrel {

// Estimates a signal that swings about a level, as the heave and the roll of a deck on waves, and
// predicts it. A bank of damped oscillators with different periods, each a Kalman filter; each
// counts as much as it has predicted well of late. Neither allocates nor throws.
class Oscillation {
 public:
  // Standard deviations of the swinging, of a measurement, and of the level's walk in a second, all
  // in the signal's unit.
  struct Spread {
    double swing;
    double measurement;
    double level_per_s;
  };
  explicit Oscillation(const Spread& spread);

  // Takes a measurement, 'seconds' after the one before.
  void Observe(double seconds, double value);

  struct Prediction {
    double value = 0;
    double rate = 0;  // per second
    double sigma = 0;
    double rate_sigma = 0;
  };
  // Returns the signal 'seconds' after the last measurement.
  Prediction Ahead(double seconds) const;

 private:
  // State: level, deviation from it, rate of the deviation.
  struct Filter {
    double rate = 0;  // angular frequency, rad/s
    double log_weight = 0;
    Eigen::Vector3d state = Eigen::Vector3d::Zero();
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  };
  void Predict(double seconds, Filter* filter) const;
  void Correct(double seconds, double value, Filter* filter) const;

  static constexpr int kPeriods = 14;
  Spread spread_;
  bool has_begun_ = false;
  std::array<Filter, kPeriods> filters_;
};

}  // namespace kestrel
