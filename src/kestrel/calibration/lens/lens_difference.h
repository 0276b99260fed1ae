// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "kestrel/core/camera/camera_model.h"

namespace kestrel {

// How far two lenses are apart: at pixels all over the image that 'truth' has within 'max_angle'
// (rad) of its axis, how far (px) 'estimate' shows the same direction from there, once the two
// are turned against each other as the mount of the camera would be. Infinite where it does not;
// empty where 'truth' has no such pixel.
std::vector<double> LensDifferencePx(const CameraModel& truth, const CameraModel& estimate,
                                     double max_angle);

}  // namespace kestrel
