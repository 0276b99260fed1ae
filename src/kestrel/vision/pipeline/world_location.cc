// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/world_location.h"

#include <cmath>
#include <numbers>

namespace kestrel {

std::optional<Eigen::Vector3d> LocateByAltitude(const Eigen::Vector3d& ray_in_camera,
                                                const RigidTransform& world_from_camera,
                                                double target_height_m) {
  constexpr double kMinSine = 0.0175;  // 1 degree
  const Eigen::Vector3d ray = world_from_camera.rotation * ray_in_camera.normalized();
  if (!(std::abs(ray.z()) > kMinSine)) return std::nullopt;
  const double distance = (target_height_m - world_from_camera.translation.z()) / ray.z();
  if (distance <= 0) return std::nullopt;
  return world_from_camera.translation + distance * ray;
}

double PatternYaw(const RigidTransform& world_from_pattern, int symmetry) {
  const double period = 2 * std::numbers::pi / symmetry;
  const double yaw = HeadingOf(world_from_pattern.rotation);
  return yaw - period * std::ceil(yaw / period - 0.5);
}

}  // namespace kestrel
