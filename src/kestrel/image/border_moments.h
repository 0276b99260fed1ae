// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/geometry/ellipse.h"
#include "kestrel/image/border_tracing.h"

namespace kestrel {

// Area, centroid and second moments of what a border encloses, by Green's theorem; in pixels,
// integer = centre of a pixel. The area is positive for holes as well.
RegionMoments ComputeBorderMoments(const GridPoint* points, std::size_t count);

}  // namespace kestrel
