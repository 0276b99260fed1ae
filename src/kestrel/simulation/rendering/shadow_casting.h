// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "kestrel/simulation/scene/world.h"

namespace kestrel {

// What is nearer to a surface lies on it: it throws no shadow on it and does not hide it.
inline constexpr double kTouching_m = 2e-3;

// A rectangle where it is at one time: in the world, or in another frame.
struct PlacedSurface {
  Eigen::Vector3d center;
  Eigen::Vector3d right;
  Eigen::Vector3d up;

  Eigen::Vector3d normal() const { return right.cross(up).normalized(); }
  double radius() const { return std::sqrt(right.squaredNorm() + up.squaredNorm()); }
};

PlacedSurface Placed(const Surface& surface, const RigidTransform& frame_from_body);

// Coordinates (x, y) of a point of a rectangle: center + x right + y up.

// How one rectangle takes the sun from another one, the receiver.
struct ShadowMap {
  const Surface* occluder;
  // (x, y, 1) of the receiver to (x, y) of the occluder straight sunwards, and the distance to it.
  Eigen::Matrix3f occluder_from_receiver;
  // Half-axes of the sun's disc as it blurs the shadow's edge, in x and y of the receiver.
  Eigen::Vector2f blur;
  // How fast the shadow moves over the receiver, in x and y per second.
  Eigen::Vector2f velocity;

  // Part of the sunlight, 0 to 1, that is taken at (x, y) of the receiver for a point (jitter) of
  // the sun's disc, at 'time_s' from the middle of the exposure.
  float Opacity(float x, float y, const Eigen::Vector2f& jitter, float time_s) const;
};

// Nothing when no point of the rectangle 'receiver' (all of its plane if 'endless') has 'occluder',
// placed at 'at', between itself and the sun.
std::optional<ShadowMap> MapShadow(const PlacedSurface& receiver, bool endless,
                                   const Surface& occluder, const PlacedSurface& at,
                                   const Lighting& light);

}  // namespace kestrel
