// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/autopilots/autopilot_model_options.h"

#include "kestrel/core/base/violations.h"

namespace kestrel {

std::vector<std::string> EstimateFaultOptions::Validate() const {
  constexpr double kLongest_s = 10000;
  std::vector<std::string> violations;
  RequireIn(silent_after_s, -1, kLongest_s, "silent_after_s", &violations);
  RequireIn(silent_for_s, 0, kLongest_s, "silent_for_s", &violations);
  RequireIn(jump_after_s, -1, kLongest_s, "jump_after_s", &violations);
  RequireIn(jump_m, -1000, 1000, "jump_m", &violations);
  RequireIn(rest_climb_mps, -5, 5, "rest_climb_mps", &violations);
  RequireIn(lost_after_s, -1, kLongest_s, "lost_after_s", &violations);
  return violations;
}

// A good estimate: its errors are not under test.
AutopilotModelOptions::AutopilotModelOptions() {
  navigation.position_noise_m = 0.003;
  navigation.position_drift_m = 0.005;
  navigation.position_bias_m = 0;
  navigation.attitude_noise_deg = 0.05;
  navigation.attitude_bias_deg = 0.05;
  navigation.mount_error_deg = 0;
  navigation.clock_offset_min_s = 0;
  navigation.clock_offset_max_s = 0;
}

std::vector<std::string> AutopilotModelOptions::Validate() const {
  std::vector<std::string> violations;
  RequireIn(system_id, 1, 255, "system_id", &violations);
  RequireIn(vehicle_type, 0, 255, "vehicle_type", &violations);
  RequireIn(uptime_s, 0, 1e6, "uptime_s", &violations);
  RequireIn(drift_ppm, -1000, 1000, "drift_ppm", &violations);
  RequireIn(origin.latitude_deg, -80, 80, "origin.latitude_deg", &violations);
  RequireIn(origin.longitude_deg, -180, 180, "origin.longitude_deg", &violations);
  RequireIn(origin.altitude_m, -500, 9000, "origin.altitude_m", &violations);
  AddViolations("uav", uav.Validate(), &violations);
  AddViolations("navigation", navigation.Validate(), &violations);
  AddViolations("estimate", estimate.Validate(), &violations);
  AddViolations("pilot", pilot.Validate(), &violations);
  return violations;
}

}  // namespace kestrel
