// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/simulation/rendering/lens.h"
#include "kestrel/vision/target/target_print.h"

namespace kestrel {

// Returns the part (0 to 1) of the area of a pad's ink that is visible in the image: inside of
// it and of the lens circle, not behind the airframe.
double VisibleFraction(const TargetPrint& print, const RigidTransform& camera_from_target,
                       const Lens& lens);

}  // namespace kestrel
