// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "kestrel/core/base/time.h"
#include "kestrel/vision/tracking/target_tracker.h"

namespace kestrel {

// The heading of a pad by single frames: a Kalman filter of one angle that wanders.
class PadHeading {
 public:
  // A frame shows it so: 'heading' and its standard deviation (rad), in a frame that does not turn
  // with the UAV. 'symmetry': turns after which the pad looks the same in it; 0: any, and the frame
  // says nothing. One that shows more than those before, as the tags on a ring's board, decides
  // anew; one that shows less does not.
  void Add(Time time, double heading, double sigma, int symmetry);

  // Returns heading and period alone; nothing: no frame has shown it.
  std::optional<TargetEstimate> At(Time time) const;

 private:
  double VarianceAt(Time time) const;

  std::optional<Time> seen_;
  double heading_ = 0;
  double variance_ = 0;
  double period_ = 0;
  int contradictions_ = 0;  // frames in a row
};

}  // namespace kestrel
