// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/scene/light_options.h"

#include <cmath>
#include <numbers>

namespace kestrel {

Lighting MakeLighting(const LightOptions& options, Random* random) {
  Lighting light;
  const double elevation = options.sun_elevation_deg * std::numbers::pi / 180;
  const double azimuth = random->Uniform(0, 2 * std::numbers::pi);
  light.to_sun = {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                  std::sin(elevation)};
  light.direct = options.direct;
  light.sky_radiance = options.sky_radiance;
  light.haze_per_m = options.visibility_m > 0 ? -std::log(0.05) / options.visibility_m : 0;
  light.haze_radiance = options.haze_radiance;
  light.haze_variation = options.dust_clouds;
  light.flare = options.flare * options.direct;
  // A lower sun is redder, and the sky is bluer than the sun.
  const double red = 0.25 * (1 - std::sin(elevation));
  light.sun_color = {1 - red, 1, 1 + 0.5 * red};
  light.sky_color = {1.12, 1, 0.9};
  return light;
}

std::vector<float> MakeSkyline(Random* random) {
  constexpr int kDirections = 720;
  std::vector<float> heights;
  while (heights.size() < kDirections) {
    const auto height = static_cast<float>(random->Uniform(0.01, 0.09));
    const bool is_tree = random->Chance(0.4);
    const int width = random->Integer(4, 40);
    for (int i = 0; i < width && heights.size() < kDirections; ++i) {
      heights.push_back(is_tree ? height * static_cast<float>(random->Uniform(0.7, 1)) : height);
    }
  }
  return heights;
}

}  // namespace kestrel
