// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "kestrel/comms/mavlink/autopilot_kind.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/set_point.h"
#include "kestrel/simulation/autopilots/vehicle_world.h"

namespace kestrel {

// The simulated pilot: keeps the UAV beside the pattern, then switches to the landing mode or gives
// the companion the guided mode. Commands from the link take over. All times are from the start of
// the simulation.
struct PilotOptions {
  double start_altitude_m = 10;  // above the pattern; 0: disarmed on the ground at the origin
  double offset_east_m = 2;      // of the UAV from the pattern
  double offset_north_m = -1;
  double heading_deg = 60;               // of its heading, clockwise from north
  double land_after_s = 5;               // negative: never
  double guide_after_s = -1;             // negative: never; otherwise instead of landing
  double take_back_after_s = -1;         // negative: never
  double battery_failsafe_after_s = -1;  // negative: never
  bool follows_vehicle = true;           // until then, as a pilot does by eye; otherwise it hovers

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("start_altitude_m", self.start_altitude_m, "m",
            "height above the pattern at the start; 0: disarmed on the ground at the origin");
    visitor("offset_east_m", self.offset_east_m, "m",
            "distance of the UAV east of the pattern at the start");
    visitor("offset_north_m", self.offset_north_m, "m",
            "distance of the UAV north of the pattern at the start");
    visitor("heading_deg", self.heading_deg, "deg", "heading of the UAV, clockwise from north");
    visitor("land_after_s", self.land_after_s, "s",
            "time at which the pilot switches to the mode that lands; negative: never");
    visitor("guide_after_s", self.guide_after_s, "s",
            "time at which the pilot switches to GUIDED or OFFBOARD instead; negative: never");
    visitor(
        "take_back_after_s", self.take_back_after_s, "s",
        "time at which the pilot switches to LOITER or POSCTL and stays there; negative: never");
    visitor("battery_failsafe_after_s", self.battery_failsafe_after_s, "s",
            "time at which the battery is low and the autopilot returns or lands; negative: never");
    visitor("follows_vehicle", self.follows_vehicle, "",
            "the pilot flies along with the vehicle until then; else the UAV hovers");
  }
  std::vector<std::string> Validate() const;
};

class SimulatedPilot {
 public:
  // The world must outlive this. Throws InputError when the options are not valid.
  SimulatedPilot(const PilotOptions& options, const VehicleWorld& world, Time start);

  // Place at which the pilot keeps the UAV.
  Eigen::Vector3d PlaceAt(Time now) const;
  // Command of the pilot, by eye, until somebody else takes over. 'position': true position of the
  // UAV.
  SetPoint FollowVehicle(Time now, const Eigen::Vector3d& position) const;
  bool follows_vehicle() const { return options_.follows_vehicle; }

  // Returns the mode to which the pilot switches at 'now'. 'flies': nobody else has taken over. The
  // pilot tries the guided mode repeatedly.
  std::optional<FlightMode> Switch(Time now, bool flies);
  // True once: the battery is low from now on.
  bool LosesBattery(Time now);
  bool has_low_battery() const { return has_low_battery_; }

 private:
  PilotOptions options_;
  const VehicleWorld& world_;
  Time start_;
  Time next_try_{};
  bool took_back_ = false;
  bool has_low_battery_ = false;
};

}  // namespace kestrel
