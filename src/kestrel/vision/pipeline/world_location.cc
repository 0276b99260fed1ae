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

Eigen::Matrix3d GroundCovariance(const Eigen::Vector3d& sight, const SightErrors& errors) {
  const auto square = [](double value) { return value * value; };
  const Eigen::Matrix3d along = sight * sight.transpose();
  const Eigen::Matrix3d across = sight.squaredNorm() * Eigen::Matrix3d::Identity() - along;
  Eigen::Matrix3d slide = Eigen::Matrix3d::Identity();
  slide.col(2) -= sight / sight.z();
  const Eigen::Matrix3d of_line = square(errors.direction_rad) * across +
                                  square(errors.position_m) * Eigen::Matrix3d::Identity();
  return slide * of_line * slide.transpose() + square(errors.ground_m / sight.z()) * along;
}

double PatternYaw(const RigidTransform& world_from_pattern, int symmetry) {
  const double period = 2 * std::numbers::pi / symmetry;
  const double yaw = HeadingOf(world_from_pattern.rotation);
  return yaw - period * std::ceil(yaw / period - 0.5);
}

}  // namespace kestrel
