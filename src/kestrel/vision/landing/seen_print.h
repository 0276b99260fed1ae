// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/vision/landing/plane_warp.h"

namespace kestrel {

// Where the image shows a print, whatever lens and sheet are: what a PlaneWarp is made of.
struct SeenPrint {
  RigidTransform near_pose;  // that the displacement is from
  PlaneWarp::Coefficients displacement_px;

  // 'camera': as the detector's; 'radius_m': the ring's outer radius. 'camera' must outlive it.
  PlaneWarp Warp(const CameraModel& camera, double radius_m) const {
    PlaneWarp warp(camera, near_pose, radius_m);
    warp.Displace(displacement_px);
    return warp;
  }
};

}  // namespace kestrel
