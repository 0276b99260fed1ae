// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "kestrel/core/camera/ray_table.h"
#include "kestrel/core/geometry/cone.h"
#include "kestrel/core/image/border_tracing.h"
#include "kestrel/vision/landing/dark_areas.h"
#include "kestrel/vision/landing/image_region.h"

namespace kestrel {

// A part of a border that bends one way without a corner: perhaps a part of an edge of the ring.
struct RingArc {
  std::size_t first = 0;  // of its points in the workspace
  std::size_t count = 0;
  RingEdge edge = RingEdge::kOuter;  // kOuter: dark on the inner side of the bend
  double turning = 0;                // rad, between its ends
  Eigen::Vector2f middle;            // of the chord, pixels of the traced image
  Eigen::Vector2f inward;            // unit vector from the chord to the inner side of the bend
  float length = 0;                  // of the chord, pixels
};

// Arcs that lie on one cone.
struct ArcRing {
  Cone cone;
  RingEdge edge;
  Eigen::Vector3d toward;  // mean ray
  double coverage = 0;     // share of the outline, 0 to 1, that the arcs cover
};

// Memory of FindArcRings, which does not allocate: arcs for which there is no room are left out.
struct RingArcsWorkspace {
  std::vector<Eigen::Vector2f> smooth;  // one border, smoothed and thinned out
  std::vector<float> turns;             // rad, around each point of it
  std::vector<Eigen::Vector2f> points;  // of all arcs, pixels of the traced image
  std::vector<Eigen::Vector3d> rays;    // of the same points
  std::vector<Eigen::Vector3d> selected;
  std::vector<RingArc> arcs;
  std::vector<char> used;
  std::vector<ArcRing> rings;

  // Makes room for the arcs of borders of so many points.
  void Reserve(std::size_t border_points);
};

// The second way to the ring, where its dark area is broken by a shadow's edge, a highlight, dirt,
// a landing leg or the image border: cuts borders of the tracer into arcs, groups those that lie on
// one cone within 'tolerance_rad', and keeps the groups that cover at least 'min_coverage' of it.
// Fills workspace->rings, best covered first. Rays are taken through 'rays' from pixels of
// 'region'.
void FindArcRings(const BorderTracer& tracer, std::span<const Border> borders, const RayTable& rays,
                  const ImageRegion& region, double tolerance_rad, double min_coverage,
                  RingArcsWorkspace* workspace);

}  // namespace kestrel
