// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "kestrel/core/base/random.h"
#include "kestrel/simulation/labelled_images/scene_renderer.h"

namespace kestrel {

// Place and properties of a shadow.
struct SunLight {
  Eigen::Vector2d center;  // approximate centre of the shadows, on the plane
  // Height of a UAV above the plane. The sun's disc makes edges soft in proportion to it.
  double height_m;
  double ambient;  // part of the light that remains in a shadow, 0 to 1
};

// A thing between the sun and the pattern. Its parts may overlap, which makes several levels of
// shadow.
struct ShadowCaster {
  std::string_view name;
  std::vector<Shadow> (*cast)(const SunLight& sun, Random* random);
};

// Five UAVs: quadcopters in X and H, a hexacopter with landing gear, one with propeller guards, a
// plane that takes off vertically.
std::span<const ShadowCaster> UavShadowCasters();

// Other things around a landing pattern: trees, masts, people, fences, parts of the vehicle.
std::span<const ShadowCaster> SurroundingShadowCasters();

// Casters of other shapes, which are never used for training: a helicopter, a coaxial octocopter on
// long legs, a lattice mast, a bush.
std::span<const ShadowCaster> HeldOutShadowCasters();

}  // namespace kestrel
