// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The detector of a pad by its description: kind, id, size, or all options of its kind.
//
// Example:
//   TargetOptions target;
//   target.kind = "apriltag";  // one of TargetKinds()
//   target.id = 3;
//   target.size_m = 0.5;
//   const auto detector = MakeTargetDetector(CameraModel(PaperCamera()), target);
//   const TargetReport report = detector->Detect(image);
//   std::cout << (report.detection ? "found" : report.reason) << "\n";

#include "kestrel/vision/targets/make_target_detector.h"  // IWYU pragma: export
