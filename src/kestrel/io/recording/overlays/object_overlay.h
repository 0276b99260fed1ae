// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/vision/mapping/mapped_object.h"
#include "kestrel/vision/pipeline/hunt_pipeline.h"

namespace kestrel {

// Returns a copy of the frame (CV_8UC3) with the detections drawn in: whole objects in white, cut
// off and merged ones in gray, each with its class, digit and distance; in gray also what looks
// like an object, with the reason why it is none. The map ('mapped') is drawn into a corner where
// the camera's pose is known.
cv::Mat DrawObjectOverlay(const cv::Mat& image, const ObjectModel& model,
                          const HuntObservation& observation,
                          const std::vector<MappedObject>& mapped = {});

}  // namespace kestrel
