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
#include "kestrel/vision/landing/candidates/dark_areas.h"
#include "kestrel/vision/landing/image_region.h"

namespace kestrel {

// A part of a border that bends one way and has no corner: possibly a part of an edge of the ring.
struct RingArc {
  std::size_t first = 0;  // index of its first point in the workspace
  std::size_t count = 0;
  RingEdge edge = RingEdge::kOuter;  // kOuter: dark on the inner side of the bend
  double turning = 0;                // rad, change of direction between its ends
  Eigen::Vector2f middle;            // middle of the chord, pixels of the traced image
  Eigen::Vector2f inward;            // unit vector from the chord to the inner side of the bend
  float length = 0;                  // length of the chord, pixels
};

// A group of arcs that lie on one cone.
struct ArcRing {
  Cone cone;
  RingEdge edge;
  Eigen::Vector3d toward;  // mean ray of the arcs
  double coverage = 0;     // share of the cone's outline that the arcs cover, 0 to 1
};

// Memory of FindArcRings, which does not allocate: arcs that do not fit are left out.
struct RingArcsWorkspace {
  std::vector<Eigen::Vector2f> smooth;  // one border, smoothed and thinned out
  std::vector<float> turns;             // rad, turn around each point of 'smooth'
  std::vector<Eigen::Vector2f> points;  // points of all arcs, pixels of the traced image
  std::vector<Eigen::Vector3d> rays;    // rays of the same points
  std::vector<Eigen::Vector3d> selected;
  std::vector<RingArc> arcs;
  std::vector<char> used;
  std::vector<ArcRing> rings;

  // Reserves memory for the arcs of 'border_points' border points.
  void Reserve(std::size_t border_points);
};

// Finds rings by arcs of borders, where the ring's dark area is broken by a shadow's edge, a
// highlight, dirt, a landing leg or the image border. Cuts the borders into arcs, groups arcs that
// lie on one cone within 'tolerance_rad', and keeps groups that cover at least 'min_coverage' of
// the cone's outline. Fills workspace->rings, best covered first. 'rays' gives the rays of
// full-resolution pixels; the borders are in pixels of 'region'.
void FindArcRings(const BorderTracer& tracer, std::span<const Border> borders, const RayTable& rays,
                  const ImageRegion& region, double tolerance_rad, double min_coverage,
                  RingArcsWorkspace* workspace);

}  // namespace kestrel
