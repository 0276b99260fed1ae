// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/base/random.h"
#include "kestrel/simulation/scene/motion.h"

namespace kestrel {

// Motion of the vehicle. Its body's frame: x forward, y left, z up, origin on the ground.
struct VehicleMotionOptions {
  std::string path = "figure8";
  double speed_mps = 4.2;
  double radius_m = 15;
  double lane_m = 3.5;
  double lane_period_s = 12;
  double shake_deg = 0.4;
  double heave_m = 0;
  double heave_period_s = 6;
  double roll_deg = 0;

  static void Visit(auto& self, auto&& visit) {
    visit("path", self.path, OneOf{{"standing", "straight", "circle", "figure8", "lanes", "stops"}},
          "path; lanes: straight, from one lane to the other and back; stops: drives off, stops, "
          "turns on the spot, again and again");
    visit("speed_mps", self.speed_mps, Range{0, 40}, "speed; the contest's 15 km/h are 4.2");
    visit("radius_m", self.radius_m, Range{2, 500},
          "radius of the circle; half the length of the figure of eight");
    visit("lane_m", self.lane_m, Range{0, 50}, "distance between the two lanes");
    visit("lane_period_s", self.lane_period_s, Range{1, 1000}, "period of two lane changes");
    visit("heave_m", self.heave_m, Range{0, 10}, "height of the waves, from trough to crest");
    visit("heave_period_s", self.heave_period_s, Range{1, 60}, "period of the waves");
    visit("roll_deg", self.roll_deg, Range{0, 45},
          "roll on the waves, to either side; half of it pitch");
    visit("shake_deg", self.shake_deg, Range{0, 10}, "roll and pitch on its springs");
  }
};

// Returns the vehicle's motion; it starts at a random place of its path at time 0.
Motion VehicleMotion(const VehicleMotionOptions& options, Random* random);

}  // namespace kestrel
