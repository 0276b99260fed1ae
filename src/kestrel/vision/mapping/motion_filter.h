// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "kestrel/vision/mapping/mapped_object.h"

namespace kestrel {

// Whether an object moves, and where it is, by its detections. Two Kalman filters run side by side:
// one of an object that stands, one of an object that drives (see ObjectMotion). Each detection
// speaks for the one that expected it, by the ratio of both likelihoods; the log-odds that the
// object moves sum this up (sequential probability ratio test, Wald 1945). Both know what errors
// detections have in common, so that the navigation's and the clock's do not look like motion.
class MotionFilter {
 public:
  MotionFilter() = default;
  // Of an object that was detected once.
  MotionFilter(const ObjectMeasurement& measurement, const ObjectMotion& motion);

  // Goes on by 'dt' > 0 seconds.
  void Predict(double dt, const ObjectMotion& motion);

  // Where the detection is expected, of an object that may have begun to drive.
  ExpectedPosition Expect(const ObjectMeasurement& measurement) const;

  void Fuse(const ObjectMeasurement& measurement, const ObjectMotion& motion);

  // Writes state, covariance, 'move_log_odds' and 'moves': of what is likelier. What rather stands
  // has no velocity; its covariance says how fast it is, if it drives after all.
  void Publish(MappedObject* object) const;

 private:
  // MappedObject's state, the shared error that wanders (m), and that of the clock offset (s).
  static constexpr int kWander = MappedObject::kStateSize;
  static constexpr int kClock = kWander + 3;
  static constexpr int kSize = kClock + 1;
  using State = Eigen::Matrix<double, kSize, 1>;
  using Covariance = Eigen::Matrix<double, kSize, kSize>;
  using Observation = Eigen::Matrix<double, 3, kSize>;

  struct Hypothesis {
    State state = State::Zero();
    Covariance covariance = Covariance::Zero();

    // 'kept': share of the wandering error that is left.
    void Predict(const MotionStep& step, double kept, double wander_sigma_m);
    ExpectedPosition Expect(const ObjectMeasurement& measurement) const;
    // The logarithm of how likely the detection was, but for a constant.
    double Fuse(const ObjectMeasurement& measurement);
    void Stop();
  };

  static Observation ObservationOf(const ObjectMeasurement& measurement);

  Hypothesis standing_;
  Hypothesis driving_;
  double log_odds_ = 0;  // that it moves
  bool moves_ = false;
};

}  // namespace kestrel
