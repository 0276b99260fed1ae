// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "kestrel/base/time.h"
#include "kestrel/navigation/pose_history.h"

namespace kestrel {

// Gives a pipeline the poses in the order of time, one further than the frame needs.
class PoseFeeder {
 public:
  explicit PoseFeeder(std::vector<PoseSample> poses) : poses_(std::move(poses)) {}

  template <class Pipeline>
  void FeedUntil(Time time, Pipeline* pipeline) {
    while (next_ < poses_.size() && (next_ == 0 || poses_[next_ - 1].time < time)) {
      pipeline->AddPose(poses_[next_++]);
    }
  }

 private:
  std::vector<PoseSample> poses_;
  std::size_t next_ = 0;
};

}  // namespace kestrel
