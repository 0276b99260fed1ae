// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/geometry/rigid_transform.h"

namespace kestrel {

// A tag of a pad that others know by its family and id.
struct TargetTag {
  std::string family;  // as its library names it
  std::int32_t id = 0;
  double size_m = 0;                // side of the square whose corners finders report
  RigidTransform pattern_from_tag;  // the tag's frame: origin in its middle, x right, y up
};

// Appearance of a pad, as far as it matters to those who draw it, look at its place in the image
// or tell its size. Frame P of the pad: origin in the middle of what is detected, z up out of the
// printed face; what x is, its detector says.
struct TargetShape {
  double diameter_m = 0;    // circle around all that is detected
  double board_size_m = 0;  // side of the square board with its margin
  // Largest size of a pixel on the board with which nearly all images of a search without a track
  // show the pad (bench/sight_range).
  double max_pixel_m = 0;
  // Closed lines along the edges of the print in frame P, m: the last point is joined to the first.
  // The first line is the outermost. A lens bends lines: straight edges have points in between.
  std::vector<std::vector<Eigen::Vector3d>> outlines;
  std::vector<TargetTag> tags{};  // that it has, if any

  double radius_m() const { return 0.5 * diameter_m; }
  // Distance (m) up to which it is found so, on the axis of the camera.
  double SightRange(const CameraIntrinsics& camera) const {
    return max_pixel_m * std::min(camera.fx_px, camera.fy_px);
  }
};

}  // namespace kestrel
