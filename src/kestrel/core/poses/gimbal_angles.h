// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "kestrel/core/geometry/angles.h"

namespace kestrel {

// Attitude of a gimbal's platform whose roll is 0: yaw from x to y of a level frame, and pitch down
// from the horizon, rad.
struct GimbalAngles {
  double yaw = 0;
  double pitch = 0;

  Eigen::Quaterniond rotation() const {
    return Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
           Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY());
  }
};

// Range of motion of a gimbal, rad: pitch from its highest (negative) to its lowest, and yaw to
// both sides of the body's heading.
struct GimbalRange {
  double highest = -kPi / 2;
  double lowest = kPi / 2;
  double side = kPi;
};

}  // namespace kestrel
