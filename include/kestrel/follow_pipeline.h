// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Follows what a person has marked in an image, and locates it on the ground.
//
// Example:
//   FollowPipeline pipeline(ReadCalibration("camera.yaml"), {.ground_height_m = 0});
//   pipeline.AddPose({.time = time, .world_from_body = {}});
//   pipeline.Mark(image, time, cv::Rect2d(310, 200, 40, 60));
//   const FollowObservation seen = pipeline.Process(image, time + std::chrono::milliseconds(33));
//   if (seen.place) std::cout << seen.place->position.transpose() << "\n";

#include "kestrel/vision/pipeline/follow_pipeline.h"  // IWYU pragma: export
