// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The whole vision of a hunt: colour images and poses in, detected objects and their map out.
//
// Example:
//   HuntPipeline pipeline(ReadCalibration("camera.yaml"), DefaultObjectModel(), {});
//   pipeline.AddPose({.time = time, .world_from_body = {}});
//   const HuntObservation& seen = pipeline.Process(color_image, time);
//   std::cout << seen.report.detections.size() << " in view\n";
//   SaveObjects("object_map.json", pipeline.map().Confirmed());

#include "kestrel/vision/pipeline/hunt_pipeline.h"  // IWYU pragma: export
