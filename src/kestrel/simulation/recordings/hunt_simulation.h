// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kestrel/core/camera/calibration.h"
#include "kestrel/simulation/recordings/recording_plan.h"
#include "kestrel/simulation/recordings/simulated_flight.h"
#include "kestrel/simulation/scene/ground_painter.h"
#include "kestrel/simulation/scene/hunt_objects.h"
#include "kestrel/simulation/scene/light_options.h"

namespace kestrel {

// Flight of the UAV over the objects.
struct HuntFlightOptions {
  std::string path = "sweep";   // sweep: back and forth over the area; descend: down to an object
  double altitude_m = 6;        // of the sweep, or at the beginning of the descent
  double end_altitude_m = 0.8;  // at the end of the descent
  double speed_mps = 3.5;       // of the sweep
  double length_m = 30;         // of the area, along the lanes
  double width_m = 20;
  double lane_m = 6.5;    // distance between lanes
  double first_lane = 0;  // lane with which the sweep begins: the UAVs of a team begin with
                          // different ones
  double attitude_noise_deg = 0.4;

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("path", self.path, "", "sweep: to and fro over the area; descend: down on an object");
    visitor("altitude_m", self.altitude_m, "m",
            "height of the sweep, or at the start of the descent");
    visitor("end_altitude_m", self.end_altitude_m, "m", "height at the end of the descent");
    visitor("speed_mps", self.speed_mps, "m/s", "speed of the sweep");
    visitor("length_m", self.length_m, "m", "length of the area, along the lanes");
    visitor("width_m", self.width_m, "m", "width of the area, across the lanes");
    visitor("lane_m", self.lane_m, "m", "distance from one lane to the next");
    visitor("first_lane", self.first_lane, "1", "lane with which the sweep begins");
    visitor("attitude_noise_deg", self.attitude_noise_deg, "deg", "errors of the attitude control");
  }
  std::vector<std::string> Validate() const;
};

// A simulated flight over coloured objects, from the motion to the sensor.
struct HuntSimulationOptions {
  FlightRecordingOptions recording = ConsumerCamera();
  HuntFlightOptions flight;
  HuntObjectsOptions objects;
  GroundOptions ground = Arena();
  LightOptions light;
  int field_seed = 0;  // seed of everything outside of the flight; 0: the recording's seed
  int banners = 4;
  int vehicles = 1;
  bool uav_shadow = true;

  static GroundOptions Arena();

  // A colour camera with rolling shutter, sharpening and compression, on a shaking mount.
  static FlightRecordingOptions ConsumerCamera();

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    FlightRecordingOptions::Visit(self.recording, visitor);
    visitor.Group("flight", self.flight);
    visitor.Group("objects", self.objects);
    visitor.Group("ground", self.ground);
    visitor.Group("light", self.light);
    visitor("field_seed", self.field_seed, "",
            "seed of the surroundings, for several flights over one field; 0: that of --seed");
    visitor("banners", self.banners, "1", "banners around");
    visitor("vehicles", self.vehicles, "1", "parked vehicles");
    visitor("uav_shadow", self.uav_shadow, "", "the UAV's shadow");
  }
  std::vector<std::string> Validate() const;
};

// Plans the recording: everything is made except the images. 'camera' has a mount (the nominal
// one). The same arguments give the same recording. Throws InputError when options are not valid.
RecordingPlan PlanHunt(const HuntSimulationOptions& options, const CameraCalibration& camera,
                       std::uint64_t seed);

}  // namespace kestrel
