// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>
#include <opencv2/core/types.hpp>

#include "kestrel/core/camera/camera_model.h"

namespace kestrel {

// Returns the part of the image that may show the ground: the pixels whose rays are at most
// 'margin_rad' above the horizon, in whole tiles of 32 px. 'up_in_camera': unit vector away from
// the ground. Nothing where the rest is less than a fifth of the image, as it is for cameras that
// look down, or where no ground is in view, so that the attitude must be wrong. Does not allocate.
std::optional<cv::Rect> PartBelowHorizon(const CameraModel& camera,
                                         const Eigen::Vector3d& up_in_camera, double margin_rad);

}  // namespace kestrel
