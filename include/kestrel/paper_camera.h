// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The fisheye camera of the paper, for trials without a calibration file.
//
// Example:
//   const CameraModel camera(PaperCamera());
//   Eigen::Vector2d pixel;
//   camera.Project({0, 0, 1}, &pixel);  // (376, 240)

#include "kestrel/core/camera/paper_camera.h"  // IWYU pragma: export
