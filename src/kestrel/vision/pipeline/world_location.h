// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>

#include "kestrel/core/geometry/rigid_transform.h"

namespace kestrel {

// Returns the intersection of the line of sight along 'ray_in_camera' (any length) with the
// horizontal plane at 'target_height_m' in the world (z up, m): the position from the camera's
// altitude (paper, section 2.5, eq. 3). Nothing when the line is less than 1 degree from the
// horizontal or the plane is not in front of the camera.
//
// With u the camera's position, r = R_WC x the ray in the world and t_z the target's height, the
// pattern is at g = u + d r, and g_z = t_z gives d = (t_z - u_z) / r_z. The paper prints
// g = u + (u_z - t_z) R_u x, which is the same only for a ray scaled to r_z = -1.
std::optional<Eigen::Vector3d> LocateByAltitude(const Eigen::Vector3d& ray_in_camera,
                                                const RigidTransform& world_from_camera,
                                                double target_height_m);

// Standard deviations of the errors of a line of sight to the ground.
struct SightErrors {
  double direction_rad = 0;  // how the line may be turned, per axis
  double position_m = 0;     // where the camera may be, per axis
  double ground_m = 0;       // how high the ground may be
};

// Returns the covariance (m^2) of a place on level ground that is seen along 'sight', the vector
// from the camera to it in the world (z up, m, not level). With v = 'sight', g = u + v, and
// P = I - v e_z^T / v_z, which slides an error along the line back to the ground,
// dg = P (du + theta x v) + v / v_z dt_z. The errors are linear: right as long as that of the
// direction is small against the depression of the line.
Eigen::Matrix3d GroundCovariance(const Eigen::Vector3d& sight, const SightErrors& errors);

// Returns the yaw of the pad's x axis in the world (rad) for a pad that looks the same under
// 'symmetry' headings (1 or more): in (-pi/symmetry, pi/symmetry], as it is known only up to
// multiples of 2 pi/symmetry.
double PatternYaw(const RigidTransform& world_from_pattern, int symmetry);

}  // namespace kestrel
