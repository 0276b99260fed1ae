// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/core/camera/calibration.h"

namespace kestrel {

// Range of the fields of view that a lens can be assumed to have, degrees.
inline constexpr double kMinFov_deg = 5, kMaxFov_deg = 220;

// Returns a lens without a calibration: square pixels, the axis in the middle, and as wide as the
// field of view, from the left edge to the right edge of the image. Up to 100 degrees it is a
// pinhole, beyond that an equidistant fisheye, as most wide lenses nearly are. 'fov_deg' is within
// the range above.
CameraIntrinsics AssumedLens(int width_px, int height_px, double fov_deg);

}  // namespace kestrel
