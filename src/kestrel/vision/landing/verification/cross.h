// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <opencv2/core.hpp>

#include "kestrel/vision/landing/landing_pattern.h"
#include "kestrel/vision/landing/verification/pattern_view.h"

namespace kestrel {

// Returns the direction of an arm of the cross inside of a ring (rad in the plane of the view,
// modulo pi / 2): the one that is darkest against what lies beside it, over the half arms in view,
// whatever hides the others. Nothing when no direction is darker by 'min_contrast' gray values. It
// is a proposal: another figure in the ring has such a direction, too.
std::optional<double> FindArmAngle(const cv::Mat& image, const PatternView& view,
                                   const LandingPattern& pattern, double min_contrast);

}  // namespace kestrel
