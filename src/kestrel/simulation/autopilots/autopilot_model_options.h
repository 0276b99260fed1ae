// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/simulation/autopilots/autopilot_messages.h"
#include "kestrel/simulation/autopilots/simulated_pilot.h"
#include "kestrel/simulation/autopilots/simulated_uav.h"
#include "kestrel/simulation/vehicle/navigation_model.h"

namespace kestrel {

// Faults of the autopilot's own estimate. Times are from the start of the simulation; negative:
// never.
struct EstimateFaultOptions {
  double silent_after_s = -1;  // it sends neither attitude nor position
  double silent_for_s = 2;
  double jump_after_s = -1;  // of the position, to the east
  double jump_m = 5;
  double lost_after_s = -1;   // of the position, for good
  double rest_climb_mps = 0;  // error of its vertical speed from touch-down on; its height drifts
  bool has_home = true;

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("silent_after_s", self.silent_after_s, "s",
            "time at which attitude and position are not sent any more; negative: never");
    visitor("silent_for_s", self.silent_for_s, "s", "duration of that silence");
    visitor("jump_after_s", self.jump_after_s, "s",
            "time at which the position jumps to the east; negative: never");
    visitor("jump_m", self.jump_m, "m", "length of the jump");
    visitor("lost_after_s", self.lost_after_s, "s",
            "time at which the position is lost for good; negative: never");
    visitor("rest_climb_mps", self.rest_climb_mps, "m/s",
            "error of the vertical speed while the UAV stands; its height drifts by it");
    visitor("has_home", self.has_home, "", "the autopilot has a home position to return to");
  }
  std::vector<std::string> Validate() const;
};

struct AutopilotModelOptions {
  AutopilotModelOptions();

  int system_id = 1;
  int vehicle_type = 2;    // MAV_TYPE in its heartbeat; it flies as a quadrotor in any case
  double uptime_s = 100;   // its own clock at the start
  double drift_ppm = 0;    // its clock is fast by this
  std::string parameters;  // "NAME=value,NAME=value": differences from the defaults
  SimulatedUavOptions uav;
  NavigationOptions navigation;  // errors of its estimate
  EstimateFaultOptions estimate;
  GlobalOrigin origin;
  PilotOptions pilot;

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("system_id", self.system_id, "1", "MAVLink system of the autopilot");
    visitor("vehicle_type", self.vehicle_type, "",
            "MAV_TYPE in its heartbeat: 2 quadrotor, 1 plane, 11 boat");
    visitor("uptime_s", self.uptime_s, "s", "time on its own clock at the start");
    visitor("drift_ppm", self.drift_ppm, "ppm", "drift of its clock; positive: fast");
    visitor("parameters", self.parameters, "",
            "parameters that differ from the defaults: NAME=value,NAME=value");
    visitor.Group("uav", self.uav);
    visitor.Group("navigation", self.navigation);
    visitor.Group("estimate", self.estimate);
    visitor.Group("origin", self.origin);
    visitor.Group("pilot", self.pilot);
  }
  std::vector<std::string> Validate() const;
};

}  // namespace kestrel
