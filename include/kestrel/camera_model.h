// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// A calibrated lens: pixels to unit rays and points to pixels, past 90 degrees from the axis.
//
// Example:
//   const CameraModel camera(PaperCamera());
//   Eigen::Vector3d ray_in_camera;
//   if (camera.Unproject({700, 240}, &ray_in_camera) == ProjectionStatus::kOk) {
//     const double from_axis_rad = std::acos(ray_in_camera.z());
//     std::cout << from_axis_rad << " rad\n";
//   }

#include "kestrel/core/camera/camera_model.h"  // IWYU pragma: export
