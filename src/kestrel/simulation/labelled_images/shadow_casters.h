// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "kestrel/core/base/random.h"
#include "kestrel/simulation/labelled_images/scene_renderer.h"

namespace kestrel {

// Where and how a shadow falls.
struct SunLight {
  Eigen::Vector2d center;  // of the shadows, about, on the plane
  double height_m;  // of a UAV above the plane; edges are as soft as the sun's disc makes them
  double ambient;   // share of the light that is left in a shadow, 0 to 1
};

// Something that stands between the sun and the pattern. Its parts may overlap, which makes several
// levels of shadow.
struct ShadowCaster {
  std::string_view name;
  std::vector<Shadow> (*cast)(const SunLight& sun, Random* random);
};

// Five UAVs: quadcopters in X and H, a hexacopter with landing gear, one with propeller guards, a
// plane that takes off vertically.
std::span<const ShadowCaster> UavShadowCasters();

// What else stands around a landing pattern: trees, masts, people, fences, parts of the vehicle.
std::span<const ShadowCaster> SurroundingShadowCasters();

// Casters of other shapes, which nothing is trained on: a helicopter, a coaxial octocopter on long
// legs, a lattice mast, a bush.
std::span<const ShadowCaster> HeldOutShadowCasters();

}  // namespace kestrel
