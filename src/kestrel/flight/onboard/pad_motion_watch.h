// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "kestrel/core/base/time.h"

namespace kestrel {

// Notices that a pad moves which is taken to stand. Over two spans of a second the UAV's place over
// the pad changes twice; the difference of the changes is an acceleration, and the UAV's
// accelerometer has measured that of the UAV alone. An acceleration that stays (a tilt error, a
// bias) is learnt and taken off, so that a pad that has always driven straight is not noticed.
class PadMotionWatch {
 public:
  PadMotionWatch();

  // The UAV's acceleration without gravity, in the frame of the places, m/s^2.
  void AddAcceleration(Time time, const Eigen::Vector3d& acceleration);

  // Takes a place (m) over the pad; true when the pad has moved by then.
  bool Update(Time time, const Eigen::Vector3d& place);

  // Begins anew, as after a jump of the place.
  void Reset();

 private:
  struct Sample {
    Time time;
    Eigen::Vector2d value;
  };

  std::optional<Eigen::Vector2d> PlaceAt(Time time) const;
  std::optional<Eigen::Vector2d> MeasuredChange(Time middle) const;

  std::vector<Sample> accelerations_, places_;  // in order of time
  std::optional<Time> learnt_;                  // the newest difference
  Eigen::Vector2d usual_{0, 0};  // slow mean of what places and accelerations differ by, m
  double learnt_s_ = 0;
  int contradictions_ = 0;  // in a row
};

}  // namespace kestrel
