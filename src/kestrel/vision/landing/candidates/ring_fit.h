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
  std::array<CirclePose, 2> poses;  // the two mirror poses of the ring's circle
};

// Fits a circle of 'radius_m' to the unit rays of a border, given in order, as a cone, and applies
// the paper's test (section 2.3, eq. 1 and 2): at least 95 % of the points must lie within the
// tolerance, here an angle (the paper's 3.5 px divided by the focal length). When that fails,
// because dirt or a shadow touches the ring, a quarter of the border is left out of the fit, and 70
// % of all points must lie within the tolerance. Rotates the order of 'border'.
std::optional<RingFit> FitRing(std::span<Eigen::Vector3d> border, double radius_m,
                               double tolerance_rad);

}  // namespace kestrel
