// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "kestrel/geometry/ellipse.h"
#include "kestrel/image/border_tracing.h"
#include "kestrel/landing/landing_pattern.h"

namespace kestrel {

// A white area that dark pixels enclose, in pixels of the traced image.
struct WhiteArea {
  Eigen::Vector2d centroid;
  double area;
  double extent;  // larger side of the bounding box
};

// Memory of FindQuadrantRings, which does not allocate: areas and rings for which there is no room
// are left out.
struct RingQuadrantsWorkspace {
  std::vector<WhiteArea> areas;
  std::vector<Ellipse> rings;

  void Reserve();
};

// A third way to a small ring, where its dark area has grown together with what is beside it: the
// four white quadrants that ring and cross leave. In an affine view they are equally large, the
// centre is half-way between two that face each other, and the centroids of two neighbours say how
// the plane is seen. Fills workspace->rings with the outer edges of the rings that any three white
// areas may belong to, by chance or not, the same ring several times.
void FindQuadrantRings(const BorderTracer& tracer, const LandingPattern& pattern,
                       RingQuadrantsWorkspace* workspace);

}  // namespace kestrel
