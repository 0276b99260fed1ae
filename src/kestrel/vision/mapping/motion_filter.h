// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "kestrel/vision/mapping/mapped_object.h"

namespace kestrel {

// Estimates from detections whether an object moves, and its position. Two Kalman filters run side
// by side: one of an object that stands, one of an object that drives (see ObjectMotion). Each
// detection is evidence for the filter that expected it, by the ratio of both likelihoods; the log
// odds that the object moves are the sum (sequential probability ratio test, Wald 1945). Both
// filters model the errors that detections share, so that errors of the navigation and of the clock
// do not look like motion.
class MotionFilter {
 public:
  MotionFilter() = default;
  // Starts with an object that was detected once.
  MotionFilter(const ObjectMeasurement& measurement, const ObjectMotion& motion);

  // Predicts over 'dt' > 0 seconds.
  void Predict(double dt, const ObjectMotion& motion);

  // Returns the expected position of a detection, for an object that may have begun to drive.
  ExpectedPosition Expect(const ObjectMeasurement& measurement) const;

  void Fuse(const ObjectMeasurement& measurement, const ObjectMotion& motion);

  // Writes state, covariance, 'move_log_odds' and 'moves' of the likelier hypothesis. An object
  // that more likely stands has no velocity; its covariance includes the speed it would have if it
  // drove.
  void Publish(MappedObject* object) const;

 private:
  // State: MappedObject's state, the shared wandering error (m), and the error of the clock offset
  // (s).
  static constexpr int kWander = MappedObject::kStateSize;
  static constexpr int kClock = kWander + 3;
  static constexpr int kSize = kClock + 1;
  using State = Eigen::Matrix<double, kSize, 1>;
  using Covariance = Eigen::Matrix<double, kSize, kSize>;
  using Observation = Eigen::Matrix<double, 3, kSize>;

  struct Hypothesis {
    State state = State::Zero();
    Covariance covariance = Covariance::Zero();

    // 'kept': share of the wandering error that remains.
    void Predict(const MotionStep& step, double kept, double wander_sigma_m);
    ExpectedPosition Expect(const ObjectMeasurement& measurement) const;
    // Returns the logarithm of the detection's likelihood, up to a constant.
    double Fuse(const ObjectMeasurement& measurement);
    void Stop();
  };

  static Observation ObservationOf(const ObjectMeasurement& measurement);

  Hypothesis standing_;
  Hypothesis driving_;
  double log_odds_ = 0;  // log odds that it moves
  bool moves_ = false;
};

}  // namespace kestrel
