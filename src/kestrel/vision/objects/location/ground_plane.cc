// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/objects/location/ground_plane.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "kestrel/vision/objects/location/disc_location.h"

namespace kestrel {

std::optional<double> GroundPlane::DistanceNear(const Eigen::Vector3d& ray, double distance,
                                                double min_height, double max_height) const {
  if (!is_known()) return std::nullopt;
  const double descent = -up_in_camera->dot(ray);
  if (descent < kMinDescent) return std::nullopt;
  const double nearest = (*camera_height_m - max_height) / descent;
  const double furthest = (*camera_height_m - min_height) / descent;
  if (!(nearest > 0)) return std::nullopt;
  return std::clamp(distance, nearest, furthest);
}

double GroundPlane::DistanceSigma(const Eigen::Vector3d& ray, double distance) const {
  const double descent = -up_in_camera->dot(ray);
  const double sideways = std::sqrt(std::max(0.0, 1 - descent * descent));
  return std::hypot(height_sigma_m, up_sigma_rad * distance * sideways) / descent;
}

PlaneBelow::PlaneBelow(const Eigen::Vector3d& up)
    : up_(up), x_axis_(up.unitOrthogonal()), y_axis_(x_axis_.cross(up)) {}

Eigen::Vector2d PlaneBelow::PointOf(const Eigen::Vector3d& ray) const {
  const Eigen::Vector2d across(x_axis_.dot(ray), y_axis_.dot(ray));
  return across / std::max(kMinDescent, -up_.dot(ray));
}

Eigen::Vector3d PlaneBelow::RayTo(const Eigen::Vector2d& point) const {
  return point.x() * x_axis_ + point.y() * y_axis_ - up_;
}

bool LooksLikeDisc(const Cone& cone, const Eigen::Vector3d& ray, double distance,
                   const Eigen::Vector3d& up, double radius, double tolerance, double slack) {
  const Eigen::Vector2d seen = cone.HalfAngles();
  const Eigen::Vector2d expected = ConeOfCircle(distance * ray, up, radius).HalfAngles();
  const auto is_near = [&](double a, double b) { return std::abs(a - b) <= tolerance * b + slack; };
  return is_near(seen(0), expected(0)) && is_near(seen(1), expected(1));
}

std::optional<PlaneRectangle> RectangleOnPlane(const std::array<Eigen::Vector3d, 4>& rays,
                                               const Eigen::Vector3d& up) {
  std::array<Eigen::Vector3d, 4> points;
  for (int i = 0; i < 4; ++i) {
    const double descent = -up.dot(rays[i]);
    if (descent < kMinDescent) return std::nullopt;
    points[i] = rays[i] / descent;
  }
  const auto length = [&](int a, int b) { return (points[a] - points[b]).norm(); };
  PlaneRectangle rectangle;
  rectangle.center = (points[0] + points[1] + points[2] + points[3]) / 4;
  rectangle.sides = {0.5 * (length(0, 1) + length(2, 3)), 0.5 * (length(1, 2) + length(3, 0))};
  const double first = length(0, 2);
  const double second = length(1, 3);
  rectangle.skew = 2 * std::abs(first - second) / (first + second);
  return rectangle;
}

}  // namespace kestrel
