// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/camera/camera_model.h"
#include "kestrel/simulation/autopilots/autopilot_messages.h"
#include "kestrel/simulation/autopilots/simulated_mount.h"
#include "kestrel/simulation/autopilots/simulated_pilot.h"
#include "kestrel/simulation/autopilots/simulated_uav.h"
#include "kestrel/simulation/vehicle/navigation_model.h"
#include "kestrel/simulation/vehicle/zoom_model.h"

namespace kestrel {

// Faults of the autopilot's own estimate. Times are from the start of the simulation; negative:
// never.
struct EstimateFaultOptions {
  double silent_after_s = -1;
  double silent_for_s = 2;
  double jump_after_s = -1;
  double jump_m = 5;
  double lost_after_s = -1;
  double rest_climb_mps = 0;
  bool has_home = true;
  bool has_gnss = true;
  double gnss_lost_after_s = -1;
  bool has_flow = false;
  bool has_range_finder = false;
  double tilt_memory_s = 30;
  double turn_after_s = -1;
  double turn_deg = 40;
  double hover_thrust_error = 0;
  double battery_sag = 0;
  double vibration = 0.3;

  static void Visit(auto& self, auto&& visit) {
    visit("silent_after_s", self.silent_after_s, Range{-1, 10000},
          "time at which attitude and position are not sent any more; negative: never");
    visit("silent_for_s", self.silent_for_s, Range{0, 10000}, "duration of that silence");
    visit("jump_after_s", self.jump_after_s, Range{-1, 10000},
          "time at which the position jumps to the east; negative: never");
    visit("jump_m", self.jump_m, Range{-1000, 1000}, "length of the jump");
    visit("lost_after_s", self.lost_after_s, Range{-1, 10000},
          "time at which the position is lost for good; negative: never");
    visit("rest_climb_mps", self.rest_climb_mps, Range{-5, 5},
          "error of the vertical speed while the UAV stands; its height drifts by it");
    visit("has_gnss", self.has_gnss,
          "the autopilot has a position by itself; otherwise only by ODOMETRY");
    visit("gnss_lost_after_s", self.gnss_lost_after_s, Range{-1, 10000},
          "time at which it has no GNSS any more: it guesses for some seconds; negative: never");
    visit("has_flow", self.has_flow, "without GNSS it knows its velocity, by optical flow");
    visit("has_range_finder", self.has_range_finder, "it reports the distance to what is below");
    visit("tilt_memory_s", self.tilt_memory_s, Range{1, 1e6},
          "time in which it takes an acceleration that lasts for tilt, without a position");
    visit(
        "turn_after_s", self.turn_after_s, Range{-1, 10000},
        "time at which its heading turns within two seconds, without a position; negative: never");
    visit("turn_deg", self.turn_deg, Range{-180, 180}, "angle of that turn, from east to north");
    visit("hover_thrust_error", self.hover_thrust_error, Range{-0.5, 0.5},
          "part by which PX4 takes the thrust that hovers for too high");
    visit("battery_sag", self.battery_sag, Range{0, 0.5},
          "part of PX4's thrust that is lost in a minute of OFFBOARD");
    visit("vibration", self.vibration, Range{0, 20},
          "[m/s^2] noise of what its accelerometer reports, standard deviation");
    visit("has_home", self.has_home, "the autopilot has a home position to return to");
  }
};

struct AutopilotModelOptions {
  AutopilotModelOptions();

  int system_id = 1;
  int vehicle_type = 2;
  double uptime_s = 100;
  double drift_ppm = 0;
  std::string parameters;
  SimulatedUavOptions uav;
  NavigationOptions navigation;
  EstimateFaultOptions estimate;
  GlobalOrigin origin;
  PilotOptions pilot;
  bool has_gripper = true;  // at the middle of its feet
  bool has_gimbal = false;  // set where the camera is on one
  SimulatedMountOptions gimbal;
  ZoomOptions zoom;              // set where the camera zooms
  CameraIntrinsics zoomed_lens;  // as that camera has it before it does

  static void Visit(auto& self, auto&& visit) {
    visit("system_id", self.system_id, Range{1, 255}, "MAVLink system of the autopilot");
    visit("vehicle_type", self.vehicle_type, Range{0, 255},
          "MAV_TYPE in its heartbeat: 2 quadrotor, 1 plane, 11 boat");
    visit("uptime_s", self.uptime_s, Range{0, 1e6}, "time on its own clock at the start");
    visit("drift_ppm", self.drift_ppm, Range{-1000, 1000}, "drift of its clock; positive: fast");
    visit("parameters", self.parameters,
          "parameters that differ from the defaults: NAME=value,NAME=value");
    visit.Group("uav", self.uav);
    visit.Group("navigation", self.navigation);
    visit.Group("estimate", self.estimate);
    visit.Group("origin", self.origin);
    visit.Group("pilot", self.pilot);
    visit("has_gripper", self.has_gripper, "it has a gripper between its feet");
    visit.Group("gimbal", self.gimbal);
  }
};

}  // namespace kestrel
