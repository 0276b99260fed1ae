// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "kestrel/core/geometry/rigid_transform.h"

namespace kestrel {

class CameraModel;
class PlaneWarp;

// Location of a print in the image, independent of errors of lens and sheet: the parts of a
// PlaneWarp.
struct SeenPrint {
  RigidTransform near_pose;  // pose to which the displacement is added
  Eigen::Matrix<double, 2, 8> displacement_px;

  // 'camera': the detector's, which must outlive the result. 'radius_m': outer radius of the ring.
  PlaneWarp Warp(const CameraModel& camera, double radius_m) const;
};

}  // namespace kestrel
