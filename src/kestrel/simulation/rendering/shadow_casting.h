// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "kestrel/simulation/scene/world.h"

namespace kestrel {

// A surface nearer than this to another lies on it: it neither shades nor hides it.
inline constexpr double kTouching_m = 2e-3;

// A rectangle at one time: in the world, or in another frame.
struct PlacedSurface {
  Eigen::Vector3d center;
  Eigen::Vector3d right;
  Eigen::Vector3d up;

  Eigen::Vector3d normal() const { return right.cross(up).normalized(); }
  double radius() const { return std::sqrt(right.squaredNorm() + up.squaredNorm()); }
};

PlacedSurface Placed(const Surface& surface, const RigidTransform& frame_from_body);

// Coordinates (x, y) of a point of a rectangle: center + x right + y up.

// The shadow of one rectangle on another one, the receiver.
struct ShadowMap {
  const Surface* occluder;
  // Maps (x, y, 1) of the receiver to (x, y) of the occluder on the same ray of the sun, and to the
  // distance.
  Eigen::Matrix3f occluder_from_receiver;
  // Half-axes of the sun's disc, which blurs the shadow's edge, in x and y of the receiver.
  Eigen::Vector2f blur;
  // Velocity of the shadow on the receiver, in x and y per second.
  Eigen::Vector2f velocity;

  // Returns the part of the sunlight, 0 to 1, that is blocked at (x, y) of the receiver for a point
  // (jitter) of the sun's disc, at 'time_s' from the middle of the exposure.
  float Opacity(float x, float y, const Eigen::Vector2f& jitter, float time_s) const;
};

// Returns nothing when 'occluder', placed at 'at', is not between the sun and any point of the
// rectangle 'receiver' (of its whole plane if 'endless').
std::optional<ShadowMap> MapShadow(const PlacedSurface& receiver, bool endless,
                                   const Surface& occluder, const PlacedSurface& at,
                                   const Lighting& light);

}  // namespace kestrel
