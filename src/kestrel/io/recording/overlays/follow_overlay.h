// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <opencv2/core.hpp>

#include "kestrel/vision/pipeline/follow_pipeline.h"

namespace kestrel {

// Returns the state of what is followed, with its distance and speed where they are known, as
// "following, 23.4 m, 3.1 m/s"; "not marked yet" before.
std::string InWords(const FollowObservation& observation);

// Returns a copy of the frame (CV_8UC3) with the box drawn in: green while the region is seen,
// yellow where it is predicted, red where it was last seen before it was lost.
cv::Mat DrawFollowOverlay(const cv::Mat& image, const FollowObservation& observation);

}  // namespace kestrel
