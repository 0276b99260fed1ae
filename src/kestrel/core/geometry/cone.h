// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include <Eigen/Core>

namespace kestrel {

// The rays through a circle form a cone with its apex in the camera: the rays r with r^T Q r = 0, Q
// symmetric with two positive eigenvalues and a negative one. Under a wide lens the image of the
// circle is not an ellipse, but the cone is always elliptic (paper, section 3.5.2).
struct Cone {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();

  // Halves of the widest and of the narrowest opening angle, rad.
  Eigen::Vector2d HalfAngles() const;

  // Angle (rad) between a unit ray and the cone, to first order (Sampson's distance).
  double AngleTo(const Eigen::Vector3d& ray) const {
    const Eigen::Vector3d half_gradient = matrix * ray;
    const double value = ray.dot(half_gradient);
    const double slope = 2 * (half_gradient - value * ray).norm();
    return std::abs(value) / std::max(slope, 1e-12);
  }
};

// Position and orientation of a circle in the frame of its cone. 'normal' is a unit vector towards
// the side from which the apex sees the circle.
struct CirclePose {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
};

// Fits the elliptic cone nearest to at least six unit rays that span less than a hemisphere (direct
// least squares fit of an ellipse in the plane tangent to their mean: Fitzgibbon, Pilu and Fisher
// 1999, in the numerically stable form of Halir and Flusser 1998). Returns nothing when the rays do
// not determine an ellipse.
std::optional<Cone> FitCone(std::span<const Eigen::Vector3d> rays);

// Returns the two poses of a circle of the given radius whose cone is 'cone' (paper, section
// 3.5.2). They coincide when the circle is seen along its axis. The centre lies in front of the
// apex, along the axis of the cone that 'toward' points to.
std::array<CirclePose, 2> CirclePosesFromCone(const Cone& cone, double radius,
                                              const Eigen::Vector3d& toward);

}  // namespace kestrel
