// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "kestrel/calibration/lens/lens_view.h"

namespace kestrel {

// At most 'max_views' of the views, in their order, each as unlike the others as can be (the
// farthest from all that are chosen is next): a camera that hovers shows the same again and again,
// which says nothing more and outweighs what does. 'width_px': of the image.
std::vector<LensView> UnlikeViews(const std::vector<LensView>& views, std::size_t max_views,
                                  int width_px);

}  // namespace kestrel
