// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/geometry/mirror_pose.h"

#include "kestrel/core/geometry/rotation_between.h"

namespace kestrel {

RigidTransform MirrorPose(const RigidTransform& camera_from_plane) {
  const Eigen::Vector3d sight = camera_from_plane.translation.normalized();
  const Eigen::Vector3d normal = camera_from_plane.rotation * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d mirrored = 2 * normal.dot(sight) * sight - normal;
  const Eigen::Quaterniond turn = RotationBetween(normal, mirrored);
  return {(turn * camera_from_plane.rotation).normalized(), camera_from_plane.translation};
}

}  // namespace kestrel
