// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/core/base/random.h"
#include "kestrel/simulation/scene/world.h"

namespace kestrel {

// Sun, sky and air.
struct LightOptions {
  double sun_elevation_deg = 50;  // 3 to 90; its azimuth is random
  double direct = 0.75;           // part of the light that comes directly from the sun; overcast: 0
  double sky_radiance = 1;        // near the horizon, in units of white
  double visibility_m = 0;        // distance at which haze or dust leaves 5 % of the light; 0:
                                  // clear air
  double dust_clouds = 0;         // relative variation of the dust's density
  double haze_radiance = 0.55;    // in units of white
  double flare = 0.3;             // sunlight that the lens scatters around the sun's image

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("sun_elevation_deg", self.sun_elevation_deg, "deg", "height of the sun");
    visitor("direct", self.direct, "1", "part of the light that comes straight from the sun");
    visitor("sky_radiance", self.sky_radiance, "1",
            "light of the sky near the horizon; white is 1");
    visitor("visibility_m", self.visibility_m, "m",
            "distance at which haze or dust leaves 5 % of the light; 0 is clear air");
    visitor("dust_clouds", self.dust_clouds, "1", "variation of the density of the dust");
    visitor("flare", self.flare, "1", "light that the lens scatters around the sun; white is 1");
    visitor("haze_radiance", self.haze_radiance, "1", "light of the haze; white is 1");
  }
  std::vector<std::string> Validate() const;
};

Lighting MakeLighting(const LightOptions& options, Random* random);

// Returns the skyline of roofs and trees on the horizon.
std::vector<float> MakeSkyline(Random* random);

// Properties of the lens that the calibration does not contain.
struct LensViewOptions {
  double half_angle_deg =
      85;  // of the lens circle; with the paper's camera 85 are as in its frames
  double vignette = 0.45;

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("half_angle_deg", self.half_angle_deg, "deg",
            "half angle of the lens circle; black beyond");
    visitor("vignette", self.vignette, "1", "part of the light that is lost at half_angle_deg");
  }
  std::vector<std::string> Validate() const;
};

}  // namespace kestrel
