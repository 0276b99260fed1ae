// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/core/geometry/ellipse.h"
#include "kestrel/core/image/border_tracing.h"
#include "kestrel/core/image/convex_hull.h"

namespace kestrel {

// Area, centroid and second moments of what a border encloses, by Green's theorem; in pixels,
// integer = centre of a pixel. The area is positive for holes as well.
RegionMoments ComputeBorderMoments(const GridPoint* points, std::size_t count);

// The same of what a convex hull encloses.
RegionMoments ComputeHullMoments(const ConvexHull& hull);

}  // namespace kestrel
