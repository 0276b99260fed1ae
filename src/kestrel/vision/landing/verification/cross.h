// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <opencv2/core.hpp>

#include "kestrel/vision/landing/landing_pattern.h"
#include "kestrel/vision/landing/location/pattern_view.h"

namespace kestrel {

// The direction of an arm of a cross.
struct ArmDirection {
  double angle;     // rad in the plane of a view, modulo pi / 2
  double contrast;  // gray values, of the arms and what lies beside them
};

// Returns the direction inside of a ring that is darkest against what lies beside it, over the half
// arms in view, whatever hides the others; nothing when no direction is darker. It is a proposal:
// another figure in the ring has such a direction, too.
std::optional<ArmDirection> FindArms(const cv::Mat& image, const PatternView& view,
                                     const LandingPattern& pattern);

}  // namespace kestrel
