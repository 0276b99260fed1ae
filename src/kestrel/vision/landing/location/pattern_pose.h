// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "kestrel/core/geometry/cone.h"
#include "kestrel/core/geometry/rigid_transform.h"

namespace kestrel {

// Returns camera_from_target for a pattern whose ring lies as 'circle', with one arm turned by
// 'arm_angle' (rad) from an arbitrary but fixed axis of the ring's plane.
inline RigidTransform PatternPose(const CirclePose& circle, double arm_angle) {
  Eigen::Matrix3d rotation;
  rotation.col(2) = circle.normal;
  rotation.col(0) = circle.normal.unitOrthogonal();
  rotation.col(1) = rotation.col(2).cross(rotation.col(0));
  RigidTransform pose;
  pose.rotation =
      Eigen::Quaterniond(rotation) * Eigen::AngleAxisd(arm_angle, Eigen::Vector3d::UnitZ());
  pose.translation = circle.center;
  return pose;
}

}  // namespace kestrel
