// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/evaluation/projected_circle.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kestrel {

std::vector<Eigen::Vector2d> ProjectCircle(const CameraModel& camera,
                                           const RigidTransform& camera_from_circle,
                                           double diameter_m) {
  constexpr int kPoints = 64;
  std::vector<Eigen::Vector2d> pixels;
  for (int i = 0; i < kPoints; ++i) {
    const double angle = 2 * std::numbers::pi * i / kPoints;
    const Eigen::Vector3d point =
        diameter_m / 2 * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0);
    Eigen::Vector2d pixel;
    if (camera.Project(camera_from_circle * point, &pixel) != ProjectionStatus::kOutsideModel) {
      pixels.push_back(pixel);
    }
  }
  return pixels;
}

double ProjectedRadius(const CameraModel& camera, const RigidTransform& camera_from_circle,
                       double diameter_m) {
  Eigen::Vector2d center;
  if (camera.Project(camera_from_circle.translation, &center) == ProjectionStatus::kOutsideModel) {
    return 0;
  }
  double radius_px = 0;
  for (const Eigen::Vector2d& pixel : ProjectCircle(camera, camera_from_circle, diameter_m)) {
    radius_px = std::max(radius_px, (pixel - center).norm());
  }
  return radius_px;
}

double ProjectedArea(const CameraModel& camera, const RigidTransform& camera_from_circle,
                     double diameter_m) {
  const auto pixels = ProjectCircle(camera, camera_from_circle, diameter_m);
  double twice_area = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const Eigen::Vector2d& a = pixels[i];
    const Eigen::Vector2d& b = pixels[(i + 1) % pixels.size()];
    twice_area += a.x() * b.y() - a.y() * b.x();
  }
  return std::abs(twice_area) / 2;
}

}  // namespace kestrel
