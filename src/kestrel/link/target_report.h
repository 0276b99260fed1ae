// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "kestrel/base/time.h"
#include "kestrel/geometry/rigid_transform.h"

namespace kestrel {

// The landing target at an instant, as the autopilot is to know it. World ENU, body FLU.
struct TargetReport {
  Time time;  // on the local clock
  Eigen::Vector3d position_in_world{0, 0, 0};
  Eigen::Vector3d velocity_in_world{0, 0, 0};
  Eigen::Matrix3d covariance_in_world = Eigen::Matrix3d::Zero();  // of the position
  RigidTransform world_from_body;                                 // of the UAV at that time
  Eigen::Vector3d body_velocity_in_world{0, 0, 0};

  Eigen::Vector3d PositionInBody() const { return world_from_body.Inverse() * position_in_world; }
};

}  // namespace kestrel
