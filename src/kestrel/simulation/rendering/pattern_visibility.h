// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/simulation/rendering/lens.h"
#include "kestrel/vision/landing/landing_pattern.h"

namespace kestrel {

// Returns the part (0 to 1) of the area of ring and cross that is visible in the image: inside of
// it and of the lens circle, not behind the airframe.
double VisibleFraction(const LandingPattern& pattern, const RigidTransform& camera_from_pattern,
                       const Lens& lens);

}  // namespace kestrel
