// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>

#include "kestrel/core/geometry/cone.h"

namespace kestrel {

// Where a point of an object is, camera frame, m.
struct ObjectLocation {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

// The cone of a circle with its centre, unit normal and radius in the camera frame.
Cone ConeOfCircle(const Eigen::Vector3d& center, const Eigen::Vector3d& normal, double radius);

// The centre of the disc of radius 'radius_m' that looks like 'cone' (paper, section 3.5).
// 'row_direction': a vector along the image's rows at the disc. 'up': unit vector, upwards in the
// camera frame, when the attitude is known.
//
// Two circles look like the cone (CirclePosesFromCone). Without 'up' nothing tells which of them it
// is, and the point between their centres is returned, on the axis of the cone. With it the disc is
// taken for horizontal. Its centre is then seen along Q^-1 up (the pole of the vanishing line of
// its plane), and its distance follows from the length of the image row through the centre: a
// rolling shutter shears the image and stretches its columns, but leaves the length of rows alone.
Eigen::Vector3d LocateDisc(const Cone& cone, double radius_m, const Eigen::Vector3d& row_direction,
                           const std::optional<Eigen::Vector3d>& up);

// Covariance of a position: 'sigma_rad' across the line of sight, 'relative_sigma' of the distance
// along it.
Eigen::Matrix3d LocationCovariance(const Eigen::Vector3d& position, double sigma_rad,
                                   double relative_sigma);

}  // namespace kestrel
