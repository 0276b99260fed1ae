// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>

#include "kestrel/core/geometry/cone.h"

namespace kestrel {

// Returns the cone of a circle, given its centre, unit normal and radius in the camera frame.
Cone ConeOfCircle(const Eigen::Vector3d& center, const Eigen::Vector3d& normal, double radius);

// Returns the centre of the disc of radius 'radius_m' whose image is 'cone' (paper, section 3.5).
// 'row_direction': a vector along the image's rows at the disc. 'up': unit vector upwards in the
// camera frame, where the attitude is known.
//
// Two circles have the same cone (CirclePosesFromCone). Without 'up' they are indistinguishable;
// the result is then the point between their centres, on the axis of the cone. With 'up' the disc
// is assumed horizontal. Its centre is then seen along Q^-1 up (the pole of the vanishing line of
// its plane), and its distance follows from the length of the image row through the centre: a
// rolling shutter shears the image and stretches its columns, but keeps the length of rows.
Eigen::Vector3d LocateDisc(const Cone& cone, double radius_m, const Eigen::Vector3d& row_direction,
                           const std::optional<Eigen::Vector3d>& up);

// Returns the covariance of a position: 'sigma_rad' across the line of sight, and 'relative_sigma'
// times the distance along it.
Eigen::Matrix3d LocationCovariance(const Eigen::Vector3d& position, double sigma_rad,
                                   double relative_sigma);

}  // namespace kestrel
