// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "kestrel/core/base/random.h"
#include "kestrel/simulation/scene/motion.h"
#include "kestrel/simulation/scene/world.h"

namespace kestrel {

// Flight of the UAV over the vehicle. Altitudes are those of the body above the pattern.
struct LandingFlightOptions {
  double start_altitude_m = 12;
  double end_altitude_m = 0.6;
  double offset_m = 0.15;          // horizontal offset from the pattern per metre of altitude
  double sway_acceleration = 0.2;  // largest acceleration of its swaying, m/s^2, less near the
                                   // pattern; the paper's calm flight: 0.2; 8 tilts the UAV by 40
                                   // degrees
  double sway_period_s = 6;
  double attitude_noise_deg = 0.3;  // fast, small errors of the attitude control
  double yaw_rate_deg = 10;         // amplitude of its slow turning, degrees per second

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("start_altitude_m", self.start_altitude_m, "m",
            "height above the pattern at the beginning");
    visitor("end_altitude_m", self.end_altitude_m, "m", "height above the pattern at the end");
    visitor("offset_m", self.offset_m, "m/m", "distance beside the pattern, per metre of altitude");
    visitor("sway_acceleration", self.sway_acceleration, "m/s^2",
            "largest acceleration of its swaying; 8 tilts the UAV by 40 deg");
    visitor("sway_period_s", self.sway_period_s, "s", "period of its swaying");
    visitor("attitude_noise_deg", self.attitude_noise_deg, "deg", "errors of the attitude control");
    visitor("yaw_rate_deg", self.yaw_rate_deg, "deg/s", "rate of its slow turning");
  }
  std::vector<std::string> Validate() const;
};

// Returns the UAV's motion above 'target' over 'duration_s', from the start altitude to the end
// altitude.
Motion LandingFlight(const LandingFlightOptions& options, const Path& target, double duration_s,
                     Random* random);

}  // namespace kestrel
