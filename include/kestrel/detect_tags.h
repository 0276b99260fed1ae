// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// All AprilTags and ArUco markers in an image, without a calibration.
//
// Example:
//   for (const TagDetection& tag : DetectTags(image, {"tag36h11", "aruco_4x4_50"})) {
//     std::cout << tag.family << " " << tag.id << " at " << tag.corners_px[0].transpose() << "\n";
//   }

#include "kestrel/vision/tags/detect_tags.h"  // IWYU pragma: export
