// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/rendering/occlusion.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "kestrel/simulation/rendering/shadow_casting.h"

namespace kestrel {
namespace {

using Eigen::Vector3d;

bool IsPainted(const Surface& surface, double x, double y) {
  if (std::abs(x) > 1 || std::abs(y) > 1) return false;
  if (surface.round && x * x + y * y > 1) return false;
  if (!surface.mask) return true;
  const Texture& mask = *surface.mask;
  return mask.Sample<1>(static_cast<float>(0.5 * (1 + x) * mask.width_px()),
                        static_cast<float>(0.5 * (1 - y) * mask.height_px()), 0)[0] >= 0.5F;
}

bool Hides(const Surface& surface, const PlacedSurface& at, const Vector3d& eye,
           const Vector3d& point) {
  const Vector3d normal = at.normal();
  const double eye_height = normal.dot(eye - at.center);
  const double point_height = normal.dot(point - at.center);
  // A surface is visible from its front only.
  if (eye_height <= 0 || point_height > -kTouching_m) return false;
  const double part = eye_height / (eye_height - point_height);
  const Vector3d hit = eye + part * (point - eye) - at.center;
  return IsPainted(surface, hit.dot(at.right) / at.right.squaredNorm(),
                   hit.dot(at.up) / at.up.squaredNorm());
}

}  // namespace

bool IsHidden(const World& world, double time_s, const Vector3d& eye, const Vector3d& point) {
  return std::ranges::any_of(world.surfaces, [&](const Surface& surface) {
    return surface.visible &&
           Hides(surface, Placed(surface, world.bodies[surface.body](time_s)), eye, point);
  });
}

}  // namespace kestrel
