// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "kestrel/core/base/time.h"

namespace kestrel {

// Another UAV of the team in the air.
struct OtherUav {
  Eigen::Vector2d position{0, 0};  // m, world
  Eigen::Vector2d velocity{0, 0};  // m/s
  bool goes_first = false;         // gives way to it
};

// The others of a team, as one of its UAVs knew them at 'time'.
struct TeamInFlight {
  Time time;
  int layer = 0;  // of this UAV's height of travel, see GuidanceInput
  std::vector<OtherUav> others;
};

}  // namespace kestrel
