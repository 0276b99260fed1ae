// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/view_limits.h"

#include <algorithm>

#include <Eigen/Geometry>

#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

using Eigen::Vector3d;

// Part of the image's shorter side that stays free at its rim: the target is no point, and the UAV
// leans a little more than it is to.
constexpr double kRim = 0.1;
constexpr double kLeast = Radians(4.0), kMost = Radians(60.0), kStep = Radians(1.0);

}  // namespace

ViewLimits::ViewLimits(const CameraIntrinsics& lens, const RigidTransform& body_from_camera)
    : camera_(lens), camera_from_body_(body_from_camera.Inverse()) {}

ViewLimits::Leans ViewLimits::LeansFor(double ahead_m, double below_m) const {
  const Vector3d target(ahead_m, 0, -below_m);
  const Vector3d x = Vector3d::UnitX(), y = Vector3d::UnitY();
  return {.forward = Largest(y, target),
          .back = Largest(-y, target),
          .side = std::min(Largest(x, target), Largest(-x, target))};
}

bool ViewLimits::Sees(double ahead_m, double below_m) const {
  return SeesLeaning(Vector3d::UnitY(), 0, {ahead_m, 0, -below_m});
}

bool ViewLimits::SeesLeaning(const Vector3d& axis, double lean, const Vector3d& target) const {
  const CameraIntrinsics& lens = camera_.intrinsics();
  const double rim_px = kRim * std::min(lens.width_px, lens.height_px);
  Eigen::Vector2d pixel;
  const Vector3d in_body = Eigen::AngleAxisd(-lean, axis) * target;
  if (camera_.Project(camera_from_body_ * in_body, &pixel) != ProjectionStatus::kOk) return false;
  return pixel.minCoeff() > rim_px && pixel.x() < lens.width_px - 1 - rim_px &&
         pixel.y() < lens.height_px - 1 - rim_px;
}

double ViewLimits::Largest(const Vector3d& axis, const Vector3d& target) const {
  double lean = kLeast;
  while (lean < kMost && SeesLeaning(axis, lean + kStep, target)) lean += kStep;
  return lean;
}

}  // namespace kestrel
