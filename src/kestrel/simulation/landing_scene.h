// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "kestrel/simulation/landing_simulation.h"
#include "kestrel/simulation/world.h"

namespace kestrel {

// A world with the landing pattern on a vehicle and a UAV above it.
struct LandingScene {
  World world;
  LandingPattern pattern;  // as it was drawn
  Motion world_from_pattern;
  Motion world_from_uav;
};

// Draws everything that 'options' leave open. Gray (1 channel) or colour (3).
LandingScene MakeLandingScene(const LandingSimulationOptions& options, int channels,
                              std::uint64_t seed);

}  // namespace kestrel
