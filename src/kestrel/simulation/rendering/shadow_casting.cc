// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/rendering/shadow_casting.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace kestrel {
namespace {

constexpr double kMinSine = 0.02;  // sine of the angle between the sun's rays and an occluder

// True when all corners of the receiver are on the same outer side of the occluder, or above it.
bool IsBeside(const Eigen::Matrix3d& map) {
  std::array<Eigen::Vector3d, 4> corners;
  for (int i = 0; i < 4; ++i) {
    corners[i] = map * Eigen::Vector3d(i % 2 ? 1 : -1, i / 2 ? 1 : -1, 1);
  }
  constexpr double kMargin = 1.3;  // for the blurred edge
  const auto all = [&](auto condition) {
    return std::all_of(corners.begin(), corners.end(), condition);
  };
  return all([](const auto& c) { return c.x() > kMargin; }) ||
         all([](const auto& c) { return c.x() < -kMargin; }) ||
         all([](const auto& c) { return c.y() > kMargin; }) ||
         all([](const auto& c) { return c.y() < -kMargin; }) ||
         all([](const auto& c) { return c.z() < kTouching_m; });
}

}  // namespace

PlacedSurface Placed(const Surface& surface, const RigidTransform& frame_from_body) {
  return {frame_from_body * surface.center, frame_from_body.rotation * surface.right,
          frame_from_body.rotation * surface.up};
}

float ShadowMap::Opacity(float x, float y, const Eigen::Vector2f& jitter, float time_s) const {
  const Eigen::Vector3f point(x + blur.x() * jitter.x() - velocity.x() * time_s,
                              y + blur.y() * jitter.y() - velocity.y() * time_s, 1);
  const Eigen::Vector3f hit = occluder_from_receiver * point;
  if (hit.z() < kTouching_m || std::abs(hit.x()) > 1 || std::abs(hit.y()) > 1) return 0;
  if (occluder->round && hit.head<2>().squaredNorm() > 1) return 0;
  if (!occluder->mask) return 1;
  const Texture& mask = *occluder->mask;
  return mask.Sample<1>(0.5f * (1 + hit.x()) * mask.width_px(),
                        0.5f * (1 - hit.y()) * mask.height_px(), 0)[0];
}

std::optional<ShadowMap> MapShadow(const PlacedSurface& receiver, bool endless,
                                   const Surface& occluder, const PlacedSurface& at,
                                   const Lighting& light) {
  const double sine = at.normal().dot(light.to_sun);
  // Solid things are closed: the sides that face the sun cast the whole shadow.
  if (sine < kMinSine) return std::nullopt;
  Eigen::Matrix3d axes;
  axes << at.right, at.up, -light.to_sun;
  const Eigen::Matrix3d inverse = axes.inverse();
  Eigen::Matrix3d map;
  map << inverse * receiver.right, inverse * receiver.up, inverse * (receiver.center - at.center);
  if (!endless && IsBeside(map)) return std::nullopt;

  // From the occluder's middle along the sun's ray down to the receiver's plane.
  const Eigen::Vector3d normal = receiver.normal();
  const double receiver_sine = std::max(normal.dot(light.to_sun), kMinSine);
  const double distance = std::max((at.center - receiver.center).dot(normal) / receiver_sine, 0.0);
  const double blur_m = distance * light.sun_radius;
  return ShadowMap{.occluder = &occluder,
                   .occluder_from_receiver = map.cast<float>(),
                   .blur = {static_cast<float>(blur_m / receiver.right.norm()),
                            static_cast<float>(blur_m / receiver.up.norm())},
                   .velocity = {0, 0}};
}

}  // namespace kestrel
