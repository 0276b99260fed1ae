// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "kestrel/core/camera/camera_model.h"

namespace kestrel {

// Returns the differences between two lenses, in px, at pixels all over the image that 'truth' has
// within 'max_angle' (rad) of its axis: the distance from each pixel to where 'estimate' shows the
// same direction, after the rotation between the two that a mount would compensate. Infinite where
// it does not show that direction; empty when 'truth' has no such pixel.
std::vector<double> LensDifferencePx(const CameraModel& truth, const CameraModel& estimate,
                                     double max_angle);

}  // namespace kestrel
