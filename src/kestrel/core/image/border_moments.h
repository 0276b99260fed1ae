// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/core/geometry/ellipse.h"
#include "kestrel/core/image/border_tracing.h"
#include "kestrel/core/image/convex_hull.h"

namespace kestrel {

// Area, centroid and second moments of the area within a border, by Green's theorem; in pixels,
// integer = centre of a pixel. The area is positive for holes too.
RegionMoments ComputeBorderMoments(const GridPoint* points, std::size_t count);

// The same for a convex hull.
RegionMoments ComputeHullMoments(const ConvexHull& hull);

}  // namespace kestrel
