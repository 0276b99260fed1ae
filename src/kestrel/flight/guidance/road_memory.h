// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "kestrel/core/base/time.h"

namespace kestrel {

// The way that a target took, and where it should be by it after it was lost. A target that came
// back to where it had been, in the same direction and about as fast (figure of eight, circle, a
// lane driven up and down), goes on as it did then. Any other goes on straight, or in its curve for
// a moment. Fixed memory.
class RoadMemory {
 public:
  // Takes the track at 'time', in order of time. A sample that follows the one before by less than
  // the memory's step is passed over.
  void Add(Time time, const Eigen::Vector2d& position, const Eigen::Vector2d& velocity,
           double turn_rate);
  void Reset() { count_ = 0; }

  // The target after the last sample.
  struct Prediction {
    Eigen::Vector2d position;
    Eigen::Vector2d velocity;
    double sigma_m;  // standard deviation per axis
    bool is_by_lap;  // it goes on as it did a lap ago
  };
  // Nothing before the first sample.
  std::optional<Prediction> Predict(Time time) const;

  // Returns the time that the target takes for a lap, s; nothing when it has not driven one.
  std::optional<double> Lap_s() const { return lap_s_; }

 private:
  static constexpr int kSamples = 1024;
  struct Sample {
    Time time;
    Eigen::Vector2d position;
    Eigen::Vector2d velocity;
  };

  const Sample& At(std::int64_t index) const { return samples_[index % kSamples]; }
  std::int64_t oldest() const { return count_ > kSamples ? count_ - kSamples : 0; }
  void FindLap();
  std::optional<Prediction> PredictByLap(double ahead_s) const;
  Prediction PredictByCurve(double ahead_s) const;

  std::array<Sample, kSamples> samples_;
  std::int64_t count_ = 0;
  double turn_rate_ = 0;  // turn rate of the newest sample, rad/s
  std::optional<double> lap_s_;
  std::int64_t lap_begin_ = 0;  // the sample at which the target was where it is now, a lap ago
};

}  // namespace kestrel
