// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/geometry/rigid_transform.h"

namespace kestrel {

// Returns the image of a circle about the origin in the plane z = 0 of its frame: points all
// around, in order. Points that the lens does not show are left out.
std::vector<Eigen::Vector2d> ProjectCircle(const CameraModel& camera,
                                           const RigidTransform& camera_from_circle,
                                           double diameter_m);

// Largest distance (px) of the circle's image from the image of its centre; 0 when none is shown.
double ProjectedRadius(const CameraModel& camera, const RigidTransform& camera_from_circle,
                       double diameter_m);

// Area (px^2) of the circle's image.
double ProjectedArea(const CameraModel& camera, const RigidTransform& camera_from_circle,
                     double diameter_m);

}  // namespace kestrel
