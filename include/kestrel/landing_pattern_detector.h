// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The detector of the landing pattern: a gray image in; a pose with its covariance out, or the
// reason why there is none.
//
// Example:
//   const LandingPatternDetector detector(CameraModel(PaperCamera()), {});
//   LandingWorkspace workspace;
//   const TargetReport report = detector.Detect(image, /*hint=*/{}, workspace);
//   if (report.detection) {
//     std::cout << report.detection->camera_from_target.translation.transpose() << " m\n";
//   } else {
//     std::cout << ToString(report.reached) << ": " << report.reason << "\n";
//   }

#include "kestrel/vision/landing/landing_pattern_detector.h"  // IWYU pragma: export
