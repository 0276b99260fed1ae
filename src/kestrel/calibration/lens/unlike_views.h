// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "kestrel/calibration/lens/lens_view.h"

namespace kestrel {

// Returns at most 'max_views' of the views, in their order, chosen to differ as much as possible:
// the next is always the one farthest from all that are chosen. A camera that hovers shows the same
// view again and again, which adds nothing and outweighs the others. 'width_px': width of the
// image.
std::vector<LensView> UnlikeViews(const std::vector<LensView>& views, std::size_t max_views,
                                  int width_px);

// Returns how much two views differ in the print's place, distance and tilt: 0.1 for a tenth of the
// image's width, or a tilt by 6 degrees.
double DifferenceOf(const LensView& view, const LensView& other, int width_px);

}  // namespace kestrel
