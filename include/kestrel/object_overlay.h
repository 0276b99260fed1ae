// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// A drawing of what a hunt pipeline found on its image.
//
// Example:
//   HuntPipeline pipeline(ReadCalibration("camera.yaml"), DefaultObjectModel(), {});
//   const HuntObservation& seen = pipeline.Process(color_image, time);
//   const cv::Mat drawn = DrawObjectOverlay(color_image, pipeline.detector().model(), seen);

#include "kestrel/io/recording/overlays/object_overlay.h"  // IWYU pragma: export
