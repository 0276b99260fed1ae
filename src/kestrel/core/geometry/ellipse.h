// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <numbers>
#include <optional>

#include <Eigen/Core>
#include <Eigen/LU>

namespace kestrel {

// An ellipse in a plane, in the plane's unit. 'angle' (rad): of the major axis, from x to y.
struct Ellipse {
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  double semi_major = 0;
  double semi_minor = 0;
  double angle = 0;

  Eigen::Vector2d major_axis() const { return {std::cos(angle), std::sin(angle)}; }
  Eigen::Vector2d minor_axis() const { return {-std::sin(angle), std::cos(angle)}; }

  // Scales both axes.
  void Scale(double factor) {
    semi_major *= factor;
    semi_minor *= factor;
  }

  // Returns the point at the eccentric anomaly 't' of the ellipse scaled by 'scale' about its
  // centre.
  Eigen::Vector2d At(double t, double scale = 1.0) const {
    return center + scale * (semi_major * std::cos(t) * major_axis() +
                             semi_minor * std::sin(t) * minor_axis());
  }
};

// Area, centroid and central second moments of a region.
struct RegionMoments {
  double area = 0;
  Eigen::Vector2d centroid = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();

  // Area divided by that of the ellipse with the same second moments: 1 for an ellipse, less for
  // every other outline without holes (0.955 for a square).
  double Ellipticity() const {
    return area / (4 * std::numbers::pi * std::sqrt(std::max(1e-12, covariance.determinant())));
  }
};

// Returns the ellipse whose interior has these moments.
Ellipse EllipseFromMoments(const RegionMoments& moments);

}  // namespace kestrel
