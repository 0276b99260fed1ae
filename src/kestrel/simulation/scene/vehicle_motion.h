// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/core/base/random.h"
#include "kestrel/simulation/scene/motion.h"

namespace kestrel {

// Motion of the vehicle. Its body's frame: x forward, y left, z up, origin on the ground.
struct VehicleMotionOptions {
  std::string path = "figure8";  // standing, straight, circle or figure8
  double speed_mps = 4.2;        // 0 to 20; the contest: 15 km/h
  double radius_m = 15;          // of the circle; half the length of the figure of eight
  double shake_deg = 0.4;        // roll and pitch on its springs, standard deviation

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("path", self.path, "", "standing, straight, circle or figure8");
    visitor("speed_mps", self.speed_mps, "m/s", "speed; the contest's 15 km/h are 4.2");
    visitor("radius_m", self.radius_m, "m",
            "radius of the circle; half the length of the figure of eight");
    visitor("shake_deg", self.shake_deg, "deg", "roll and pitch on its springs");
  }
  std::vector<std::string> Validate() const;
};

// Returns the vehicle's motion; it starts at a random place of its path at time 0.
Motion VehicleMotion(const VehicleMotionOptions& options, Random* random);

}  // namespace kestrel
