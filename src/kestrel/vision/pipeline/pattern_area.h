// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/vision/target/target_detection.h"
#include "kestrel/vision/target/target_shape.h"

namespace kestrel {

// Returns the rectangle around the pad in the image, for exposure control, clipped at
// the image border. Empty where no part of it is in view.
cv::Rect PatternArea(const TargetDetection& detection, const TargetShape& shape,
                     const CameraModel& camera);

}  // namespace kestrel
