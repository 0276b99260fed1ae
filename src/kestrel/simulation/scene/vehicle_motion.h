// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/core/base/random.h"
#include "kestrel/simulation/scene/motion.h"

namespace kestrel {

// Motion of the vehicle. Its body's frame: x forward, y left, z up, origin on the ground.
struct VehicleMotionOptions {
  // standing, straight, circle, figure8; lanes: straight, from one lane to the other and back;
  // stops: drives off, stops, turns on the spot by a quarter turn, again and again
  std::string path = "figure8";
  double speed_mps = 4.2;     // 0 to 40; the contest: 15 km/h; of "stops" the largest
  double radius_m = 15;       // of the circle; half the length of the figure of eight
  double lane_m = 3.5;        // from one lane to the other
  double lane_period_s = 12;  // of two changes
  double shake_deg = 0.4;     // roll and pitch on its springs, standard deviation
  // On waves. Heave from trough to crest; roll and half of it as pitch, each to either side.
  double heave_m = 0;
  double heave_period_s = 6;
  double roll_deg = 0;

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("path", self.path, "", "standing, straight, circle, figure8, lanes or stops");
    visitor("speed_mps", self.speed_mps, "m/s", "speed; the contest's 15 km/h are 4.2");
    visitor("radius_m", self.radius_m, "m",
            "radius of the circle; half the length of the figure of eight");
    visitor("lane_m", self.lane_m, "m", "distance between the two lanes");
    visitor("lane_period_s", self.lane_period_s, "s", "period of two lane changes");
    visitor("heave_m", self.heave_m, "m", "height of the waves, from trough to crest");
    visitor("heave_period_s", self.heave_period_s, "s", "period of the waves");
    visitor("roll_deg", self.roll_deg, "deg",
            "roll on the waves, to either side; half of it pitch");
    visitor("shake_deg", self.shake_deg, "deg", "roll and pitch on its springs");
  }
  std::vector<std::string> Validate() const;
};

// Returns the vehicle's motion; it starts at a random place of its path at time 0.
Motion VehicleMotion(const VehicleMotionOptions& options, Random* random);

}  // namespace kestrel
