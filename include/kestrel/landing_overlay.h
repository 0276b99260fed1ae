// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// A drawing of what a landing pipeline found, or why it found nothing, on its image.
//
// Example:
//   LandingPipeline pipeline(ReadCalibration("camera.yaml"), {});
//   const LandingObservation seen = pipeline.Process(image, time);
//   const cv::Mat drawn = DrawLandingOverlay(image, pipeline.detector().camera(),
//                                            pipeline.detector().shape(), seen);

#include "kestrel/io/recording/overlays/landing_overlay.h"  // IWYU pragma: export
