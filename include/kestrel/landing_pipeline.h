// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The whole vision of a landing: images and poses in; the pattern, its position in the world and
// its track out.
//
// Example:
//   LandingPipeline pipeline(ReadCalibration("camera.yaml"), {});
//   pipeline.AddPose({.time = time, .world_from_body = {}});
//   const LandingObservation seen = pipeline.Process(image, time);
//   if (seen.center_in_world) std::cout << seen.center_in_world->transpose() << " m\n";
//   const auto soon = pipeline.tracker().Predict(time + std::chrono::milliseconds(500));

#include "kestrel/vision/pipeline/landing_pipeline.h"  // IWYU pragma: export
