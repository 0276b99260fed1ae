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
  double radius_m;  // unit of length of the displacement's polynomial

  // 'camera': the detector's, which must outlive the result.
  PlaneWarp Warp(const CameraModel& camera) const;
};

}  // namespace kestrel
