// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/scene/light_options.h"

#include <cmath>
#include <numbers>

#include "kestrel/core/base/violations.h"

namespace kestrel {

std::vector<std::string> LightOptions::Validate() const {
  std::vector<std::string> violations;
  RequireIn(sun_elevation_deg, 3, 90, "sun_elevation_deg", &violations);
  RequireIn(direct, 0, 1, "direct", &violations);
  RequireIn(sky_radiance, 0, 10, "sky_radiance", &violations);
  RequireIn(visibility_m, 0, 1e5, "visibility_m", &violations);
  RequireIn(dust_clouds, 0, 1, "dust_clouds", &violations);
  RequireIn(flare, 0, 100, "flare", &violations);
  RequireIn(haze_radiance, 0, 10, "haze_radiance", &violations);
  return violations;
}

std::vector<std::string> LensViewOptions::Validate() const {
  std::vector<std::string> violations;
  RequireIn(half_angle_deg, 1, 180, "half_angle_deg", &violations);
  RequireIn(vignette, 0, 1, "vignette", &violations);
  return violations;
}

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
