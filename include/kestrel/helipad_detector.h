// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The detector of a helipad by its H.
//
// Example:
//   HelipadDetectorOptions options;
//   options.height_m = 2;
//   const HelipadDetector detector(CameraModel(PaperCamera()), options);
//   if (const TargetReport report = detector.Detect(image); report.detection) {
//     std::cout << report.detection->camera_from_target.translation.transpose() << " m\n";
//   }

#include "kestrel/vision/helipad/helipad_detector.h"  // IWYU pragma: export
