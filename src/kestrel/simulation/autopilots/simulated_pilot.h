// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "kestrel/comms/mavlink/autopilot_kind.h"
#include "kestrel/core/base/limits.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/set_point.h"
#include "kestrel/simulation/autopilots/vehicle_world.h"

namespace kestrel {

// The simulated pilot: keeps the UAV beside the pattern, then switches to the landing mode or gives
// the companion the guided mode. Commands from the link take over. All times are from the start of
// the simulation.
struct PilotOptions {
  double start_altitude_m = 10;
  double offset_east_m = 2;
  double offset_north_m = -1;
  double heading_deg = 60;
  double land_after_s = 5;
  double guide_after_s = -1;
  double take_back_after_s = -1;
  double battery_failsafe_after_s = -1;
  bool follows_vehicle = true;
  bool has_sticks = false;

  static void Visit(auto& self, auto&& visit) {
    visit("start_altitude_m", self.start_altitude_m, Range{0, 200},
          "height above the pattern at the start; 0: disarmed on the ground at the origin");
    visit("offset_east_m", self.offset_east_m, Range{-100, 100},
          "place of the UAV, east of the pattern");
    visit("offset_north_m", self.offset_north_m, Range{-100, 100}, "place of the UAV, north of it");
    visit("heading_deg", self.heading_deg, Range{-360, 360}, "heading, clockwise from north");
    visit("land_after_s", self.land_after_s, Range{-1, 10000},
          "time at which the pilot switches to the mode that lands; negative: never");
    visit("guide_after_s", self.guide_after_s, Range{-1, 10000},
          "time at which the pilot switches to GUIDED or OFFBOARD instead; negative: never");
    visit("take_back_after_s", self.take_back_after_s, Range{-1, 10000},
          "time at which the pilot switches to LOITER or POSCTL and stays there; negative: never");
    visit("battery_failsafe_after_s", self.battery_failsafe_after_s, Range{-1, 10000},
          "time at which the battery is low and the autopilot returns or lands; negative: never");
    visit("follows_vehicle", self.follows_vehicle,
          "the pilot flies along with the vehicle until then; else the UAV hovers");
    visit("has_sticks", self.has_sticks, "there is a transmitter, with the throttle in its middle");
  }
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
  bool has_sticks() const { return options_.has_sticks; }

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
