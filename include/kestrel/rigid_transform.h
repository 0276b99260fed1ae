// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Rigid transforms between frames, named by cancellation: world_from_camera = world_from_body *
// body_from_camera.
//
// Example:
//   const RigidTransform world_from_body{RotationBy({0, 0, 1.57}), {0, 0, 10}};
//   const RigidTransform body_from_camera{RotationBy({3.14159, 0, 0}), {0.1, 0, 0}};
//   const RigidTransform world_from_camera = world_from_body * body_from_camera;
//   const Eigen::Vector3d point_in_world = world_from_camera * Eigen::Vector3d(0, 0, 10);

#include "kestrel/core/geometry/rigid_transform.h"  // IWYU pragma: export
