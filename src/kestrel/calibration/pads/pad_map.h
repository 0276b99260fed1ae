// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "kestrel/core/geometry/rigid_transform.h"

namespace kestrel {

// A pad in an image, by its index.
struct PadSighting {
  std::size_t pad = 0;
  RigidTransform camera_from_pad;
};

// Place of a pad in the plane of all, in the frame of the first one.
struct PadPlace {
  Eigen::Vector2d position{0, 0};  // m
  double yaw = 0;                  // of its x axis, rad from x to y
  // Standard deviations: of the position in the worse direction, m, and of the yaw, rad; 0 for the
  // first pad, which is the origin.
  double position_sigma_m = 0;
  double yaw_sigma = 0;
  int images = 0;  // that showed it beside another pad
};

struct PadMap {
  std::vector<std::optional<PadPlace>> places;  // nothing: no chain of images leads to that pad
  double rms_px = 0;                            // of the pads' corners
  int images = 0;                               // used
};

// Returns where square pads lie on one plane, from images that show several of them at once.
//
// Bundle adjustment: the poses of the camera and the places of the pads that agree best with the
// corners of the pads in the images, by least squares with Cauchy's loss. 'images': the pads that
// each image shows; 'sizes_m': sides of the pads, the first one is the origin; 'focal_px': pixels
// per radian, in which the corners' errors count. Throws InputError when no image shows the first
// pad beside another one.
PadMap EstimatePadMap(std::span<const std::vector<PadSighting>> images,
                      std::span<const double> sizes_m, double focal_px);

}  // namespace kestrel
