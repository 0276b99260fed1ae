// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "kestrel/geometry/cone.h"
#include "kestrel/geometry/ellipse.h"

namespace kestrel {

// A ring fitted to the rays of border points.
struct RingFit {
  Cone cone;
  std::array<CirclePose, 2> poses;  // of the ring's circle, mirror images of each other
};

// Fits a circle of 'radius_m' to unit rays as a cone and applies the paper's test (section 2.3, eq.
// 1 and 2): at least 95 % of the points lie within the tolerance of it, an angle here (the paper's
// 3.5 px divided by the focal length).
std::optional<RingFit> FitRing(std::span<const Eigen::Vector3d> rays, double radius_m,
                               double tolerance_rad);

}  // namespace kestrel
