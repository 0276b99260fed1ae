// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/vision/landing/plane_warp.h"

namespace kestrel {

// Location of a print in the image, independent of errors of lens and sheet: the parts of a
// PlaneWarp.
struct SeenPrint {
  RigidTransform near_pose;  // pose to which the displacement is added
  PlaneWarp::Coefficients displacement_px;

  // 'camera': the detector's, which must outlive the result. 'radius_m': outer radius of the ring.
  PlaneWarp Warp(const CameraModel& camera, double radius_m) const {
    PlaneWarp warp(camera, near_pose, radius_m);
    warp.Displace(displacement_px);
    return warp;
  }
};

}  // namespace kestrel
