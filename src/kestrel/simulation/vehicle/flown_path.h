// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "kestrel/core/geometry/rigid_transform.h"

namespace kestrel {

// The poses of a body, step by step, while a simulation runs: a motion that grows.
class FlownPath {
 public:
  // The first pose that is added is that of 'begin_s'; the following ones are 'step_s' apart.
  FlownPath(double begin_s, double step_s) : begin_s_(begin_s), step_s_(step_s) {}

  void Add(const RigidTransform& world_from_body) { poses_.push_back(world_from_body); }

  // Interpolates between two steps by straight line and shortest arc; before the first and after
  // the last pose it returns that pose. There must be at least one pose.
  RigidTransform At(double time_s) const;

  double end_s() const { return begin_s_ + step_s_ * (static_cast<double>(poses_.size()) - 1); }

 private:
  double begin_s_;
  double step_s_;
  std::vector<RigidTransform> poses_;
};

}  // namespace kestrel
