// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"
#include "kestrel/vision/target/target_shape.h"

namespace kestrel {

struct LandingOverlayOptions {
  bool only_in_image = false;  // without distance, as the lens is not known
  // Predicted places of the pad in the world (m, ENU), in order of time from the frame on.
  std::vector<Eigen::Vector3d> path_in_world;
};

// Returns the frame (CV_8UC1, or CV_8UC3 in BGR) with the result drawn in, as CV_8UC3 (BGR). With a
// detection: the outlines of the pad as the pose projects them through the lens, the centre, the
// axes (x red, y green, z blue), and in words what it is, id, distance and quality. Otherwise: the
// stage at which the best candidate was rejected, and why. For a misfit also the print where it is
// seen, in another colour. Where the pose of the camera is known: the path of the track. At the
// bottom a legend of the colours.
cv::Mat DrawLandingOverlay(const cv::Mat& image, const CameraModel& camera,
                           const TargetShape& shape, const LandingObservation& observation,
                           const LandingOverlayOptions& options = {});

}  // namespace kestrel
