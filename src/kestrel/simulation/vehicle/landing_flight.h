// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include <Eigen/Geometry>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/base/random.h"
#include "kestrel/simulation/scene/motion.h"
#include "kestrel/simulation/scene/world.h"

namespace kestrel {

// Flight of the UAV over the vehicle. Altitudes are those of the body above the pattern.
struct LandingFlightOptions {
  double start_altitude_m = 12;
  double end_altitude_m = 0.6;
  double offset_m = 0.15;
  double sway_acceleration = 0.2;
  double sway_period_s = 6;
  double attitude_noise_deg = 0.3;
  double yaw_rate_deg = 10;

  static void Visit(auto& self, auto&& visit) {
    visit("start_altitude_m", self.start_altitude_m, Range{0.1, 100},
          "height above the pattern at first");
    visit("end_altitude_m", self.end_altitude_m, Range{0.1, 100}, "the same at the end");
    visit("offset_m", self.offset_m, Range{0, 3},
          "[m/m] distance beside the pattern, per metre of altitude");
    visit("sway_acceleration", self.sway_acceleration, Range{0, 15},
          "[m/s^2] largest acceleration of its swaying; 8 tilts the UAV by 40 deg");
    visit("sway_period_s", self.sway_period_s, Range{0.5, 60}, "period of its swaying");
    visit("attitude_noise_deg", self.attitude_noise_deg, Range{0, 10},
          "errors of the attitude control");
    visit("yaw_rate_deg", self.yaw_rate_deg, Range{0, 360}, "[deg/s] rate of its slow turning");
  }
};

// Returns the UAV's motion above 'target' over 'duration_s', from the start altitude to the end
// altitude.
Motion LandingFlight(const LandingFlightOptions& options, const Path& target, double duration_s,
                     Random* random);

}  // namespace kestrel
