// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/vision/landing/landing_pattern.h"
#include "kestrel/vision/landing/landing_pattern_detector.h"

namespace kestrel {

// Where the image has the pattern, for exposure control: the rectangle around its ring, cut off at
// the image's border. Empty where nothing of it is in the image.
cv::Rect PatternArea(const LandingDetection& detection, const LandingPattern& pattern,
                     const CameraModel& camera);

}  // namespace kestrel
