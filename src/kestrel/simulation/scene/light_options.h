// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/base/random.h"
#include "kestrel/simulation/scene/world.h"

namespace kestrel {

// Sun, sky and air.
struct LightOptions {
  double sun_elevation_deg = 50;
  double direct = 0.75;
  double sky_radiance = 1;
  double visibility_m = 0;
  double dust_clouds = 0;
  double haze_radiance = 0.55;
  double flare = 0.3;

  static void Visit(auto& self, auto&& visit) {
    visit("sun_elevation_deg", self.sun_elevation_deg, Range{3, 90}, "height of the sun");
    visit("direct", self.direct, Range{0, 1}, "part of the light that comes straight from the sun");
    visit("sky_radiance", self.sky_radiance, Range{0, 10},
          "light of the sky at the horizon; white is 1");
    visit("visibility_m", self.visibility_m, Range{0, 1e5},
          "distance at which haze or dust leaves 5 % of the light; 0 is clear air");
    visit("dust_clouds", self.dust_clouds, Range{0, 1}, "variation of the density of the dust");
    visit("flare", self.flare, Range{0, 100}, "light scattered around the sun; white is 1");
    visit("haze_radiance", self.haze_radiance, Range{0, 10}, "light of the haze; white is 1");
  }
};

Lighting MakeLighting(const LightOptions& options, Random* random);

// Returns the skyline of roofs and trees on the horizon.
std::vector<float> MakeSkyline(Random* random);

// Properties of the lens that the calibration does not contain.
struct LensViewOptions {
  double half_angle_deg = 85;
  double vignette = 0.45;

  static void Visit(auto& self, auto&& visit) {
    visit("half_angle_deg", self.half_angle_deg, Range{1, 180},
          "half angle of the lens circle; black beyond");
    visit("vignette", self.vignette, Range{0, 1},
          "part of the light that is lost at half_angle_deg");
  }
};

}  // namespace kestrel
