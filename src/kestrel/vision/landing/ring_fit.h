// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "kestrel/core/geometry/cone.h"
#include "kestrel/core/geometry/ellipse.h"

namespace kestrel {

// A ring fitted to the rays of border points.
struct RingFit {
  Cone cone;
  std::array<CirclePose, 2> poses;  // of the ring's circle, mirror images of each other
};

// Fits a circle of 'radius_m' to the unit rays of a border, in its order, as a cone and applies the
// paper's test (section 2.3, eq. 1 and 2): at least 95 % of the points lie within the tolerance of
// it, an angle here (the paper's 3.5 px divided by the focal length). Where they do not, because
// dirt or a shadow touches the ring, a quarter of the border is left out of the fit, and 70 % of
// all points must lie within the tolerance. Moves the rays around the border.
std::optional<RingFit> FitRing(std::span<Eigen::Vector3d> border, double radius_m,
                               double tolerance_rad);

}  // namespace kestrel
