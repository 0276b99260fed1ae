// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/geometry/ellipse.h"
#include "kestrel/image/border_tracing.h"

namespace kestrel {

// Area, centroid and second moments of what a border encloses, by Green's theorem; in pixels,
// integer = centre of a pixel. The area is positive for holes as well.
RegionMoments ComputeBorderMoments(const GridPoint* points, std::size_t count);

// The tallest border of which ComputeHullMoments is told, vertices of a column.
inline constexpr int kMaxHullHeight = 64;

// The same of the convex hull of a border that is at most kMaxHullHeight - 1 pixels high. The
// border may cross itself and run either way.
RegionMoments ComputeHullMoments(const GridPoint* points, std::size_t count);

}  // namespace kestrel
