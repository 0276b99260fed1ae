// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "kestrel/core/camera/ray_table.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/core/image/border_tracing.h"
#include "kestrel/core/image/polyline.h"
#include "kestrel/vision/landing/landing_pattern.h"
#include "kestrel/vision/landing/location/pattern_view.h"

namespace kestrel {

// Memory of FindPartialPatterns. Does not allocate for borders of at most as many points as are
// reserved.
struct PartialPatternWorkspace {
  std::vector<Eigen::Vector2d> plane;  // one border, in the plane
  std::vector<std::size_t> breaks;
  std::vector<LineSegment> segments;
  // Two parallel border lines with black between them: an arm or a part of one.
  struct Bar {
    Eigen::Vector2d middle;
    Eigen::Vector2d direction;  // unit vector
    double width;
    double length;
  };
  std::vector<Bar> bars;
  std::vector<RigidTransform> poses;

  void Reserve(std::size_t border_points);
};

// Finds crosses of patterns whose ring is not in view (paper, section 2.4: at least four border
// lines of the cross). The borders are projected onto the plane at unit distance below the camera;
// there, straight lines and right angles of the print stay so under any lens. The borders are cut
// into lines. Pairs of parallel lines make bars, and two bars of one width at right angles make a
// cross. Its centre is where the axes meet, inside or outside of the image. Fills workspace->poses,
// the longest bars first. 'up_in_camera': unit vector away from the ground, the normal of the
// plane.
void FindPartialPatterns(const BorderTracer& tracer, const RayTable& rays,
                         const ImageRegion& region, const LandingPattern& pattern,
                         const Eigen::Vector3d& up_in_camera, PartialPatternWorkspace* workspace);

}  // namespace kestrel
