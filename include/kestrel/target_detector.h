// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The interface of what finds a pad: of the kinds that Kestrel has, and of a pad of your own
// (docs/own_pad.md).
//
// Example:
//   auto detector = std::make_unique<LandingPatternDetector>(CameraModel(PaperCamera()),
//                                                            LandingPatternDetectorOptions());
//   const TargetDetector& any = *detector;
//   const std::unique_ptr<TargetWorkspace> workspace = any.MakeWorkspace();
//   if (any.Detect(image, /*hint=*/{}, *workspace).detection) {
//     std::cout << "a pad of " << any.shape().diameter_m << " m\n";
//   }
//   LandingPipeline pipeline(PaperCalibration(), std::move(detector), /*options=*/{});

#include "kestrel/vision/target/target_detector.h"  // IWYU pragma: export
