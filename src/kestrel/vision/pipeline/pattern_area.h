// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/vision/landing/landing_pattern.h"
#include "kestrel/vision/landing/landing_pattern_detector.h"

namespace kestrel {

// Returns the rectangle around the pattern's ring in the image, for exposure control, clipped at
// the image border. Empty where no part of it is in view.
cv::Rect PatternArea(const LandingDetection& detection, const LandingPattern& pattern,
                     const CameraModel& camera);

}  // namespace kestrel
