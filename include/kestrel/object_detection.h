// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// A coloured object in an image: its class, its position in the camera frame and its digit.
//
// Example:
//   const ObjectDetection detection;
//   if (detection.completeness == Completeness::kWhole && detection.location) {
//     std::cout << detection.location->position.transpose() << " m in the camera frame\n";
//   }
//   if (detection.digits) std::cout << LikeliestDigit(*detection.digits).digit << "\n";

#include "kestrel/vision/objects/object_detection.h"  // IWYU pragma: export
