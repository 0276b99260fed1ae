// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

#include "kestrel/vision/pipeline/hunt_pipeline.h"

namespace kestrel {

// Returns a copy of the frame (CV_8UC3) with the detections drawn in: whole objects in white, cut
// off and merged ones in gray, each with its class, digit and distance.
cv::Mat DrawObjectOverlay(const cv::Mat& image, const ObjectModel& model,
                          const HuntObservation& observation);

}  // namespace kestrel
