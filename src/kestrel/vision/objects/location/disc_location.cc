// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/objects/location/disc_location.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "kestrel/vision/objects/location/ground_plane.h"

namespace kestrel {
namespace {

// Length of the chord that the cone cuts from the line ray + t * direction.
double ChordLength(const Cone& cone, const Eigen::Vector3d& ray, const Eigen::Vector3d& direction) {
  const double a = direction.dot(cone.matrix * direction);
  const double b = direction.dot(cone.matrix * ray);
  const double c = ray.dot(cone.matrix * ray);
  if (!(std::abs(a) > 0)) return 0;
  return 2 * std::sqrt(std::max(0.0, b * b - a * c)) / std::abs(a);
}

}  // namespace

Cone ConeOfCircle(const Eigen::Vector3d& center, const Eigen::Vector3d& normal, double radius) {
  // A ray r meets the plane at s r, s = (n.c) / (n.r); on the cone |s r - c| = radius.
  const double height = normal.dot(center);
  const Eigen::Matrix3d mixed = normal * center.transpose();
  Cone cone;
  cone.matrix = height * height * Eigen::Matrix3d::Identity() -
                height * (mixed + mixed.transpose()) +
                (center.squaredNorm() - radius * radius) * normal * normal.transpose();
  cone.matrix /= cone.matrix.norm();
  return cone;
}

Eigen::Vector3d LocateDisc(const Cone& cone, double radius_m, const Eigen::Vector3d& row_direction,
                           const std::optional<Eigen::Vector3d>& up) {
  const auto poses = CirclePosesFromCone(cone, radius_m, Eigen::Vector3d::UnitZ());
  Eigen::Vector3d by_cone = 0.5 * (poses[0].center + poses[1].center);
  if (!up) return by_cone;
  Eigen::Vector3d ray = cone.matrix.inverse() * *up;
  if (ray.dot(by_cone) < 0) ray = -ray;
  ray.normalize();
  // The plane must be seen from above, and not edge-on.
  if (!(up->dot(ray) < -kMinDescent)) return by_cone;
  const double guess = by_cone.norm();
  const Cone horizontal = ConeOfCircle(guess * ray, *up, radius_m);
  const double seen = ChordLength(cone, ray, row_direction);
  if (!(seen > 0)) return by_cone;
  return guess * ChordLength(horizontal, ray, row_direction) / seen * ray;
}

Eigen::Matrix3d LocationCovariance(const Eigen::Vector3d& position, double sigma_rad,
                                   double relative_sigma) {
  const double distance = position.norm();
  const Eigen::Vector3d ray = position / distance;
  const Eigen::Matrix3d along = ray * ray.transpose();
  const double across_m = sigma_rad * distance;
  const double along_m = relative_sigma * distance;
  return across_m * across_m * (Eigen::Matrix3d::Identity() - along) + along_m * along_m * along;
}

}  // namespace kestrel
