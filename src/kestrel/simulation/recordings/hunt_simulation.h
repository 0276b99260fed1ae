// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/simulation/recordings/recording_plan.h"
#include "kestrel/simulation/recordings/simulated_flight.h"
#include "kestrel/simulation/scene/ground_painter.h"
#include "kestrel/simulation/scene/hunt_objects.h"
#include "kestrel/simulation/scene/light_options.h"

namespace kestrel {

// Flight of the UAV over the objects.
struct HuntFlightOptions {
  std::string path = "sweep";
  double altitude_m = 6;
  double end_altitude_m = 0.8;
  double speed_mps = 3.5;
  double length_m = 30;
  double width_m = 20;
  double lane_m = 6.5;
  double first_lane = 0;
  double attitude_noise_deg = 0.4;

  static void Visit(auto& self, auto&& visit) {
    visit("path", self.path, OneOf{{"sweep", "descend"}},
          "sweep: to and fro over the area; descend: down on an object");
    visit("altitude_m", self.altitude_m, Range{0.5, 50},
          "height of the sweep, or at the start of the descent");
    visit("end_altitude_m", self.end_altitude_m, Range{0.3, 50},
          "height at the end of the descent");
    visit("speed_mps", self.speed_mps, Range{0.1, 10}, "speed of the sweep");
    visit("length_m", self.length_m, Range{5, 200}, "length of the area, along the lanes");
    visit("width_m", self.width_m, Range{2, 200}, "width of the area, across the lanes");
    visit("lane_m", self.lane_m, Range{1, 50}, "distance from one lane to the next");
    visit("first_lane", self.first_lane, Range{0, 100}, "lane with which the sweep begins");
    visit("attitude_noise_deg", self.attitude_noise_deg, Range{0, 10},
          "errors of the attitude control");
  }
};

// A simulated flight over coloured objects, from the motion to the sensor.
struct HuntSimulationOptions {
  FlightRecordingOptions recording = ConsumerCamera();
  HuntFlightOptions flight;
  HuntObjectsOptions objects;
  GroundOptions ground = Arena();
  LightOptions light;
  int field_seed = 0;
  int banners = 4;
  int vehicles = 1;
  bool uav_shadow = true;

  static GroundOptions Arena();

  static FlightRecordingOptions ConsumerCamera();

  static void Visit(auto& self, auto&& visit) {
    visit.Group(self.recording);
    visit.Group("flight", self.flight);
    visit.Group("objects", self.objects);
    visit.Group("ground", self.ground);
    visit.Group("light", self.light);
    visit("field_seed", self.field_seed, Range{0, 1000000000},
          "seed of the surroundings, for several flights over one field; 0: that of --seed");
    visit("banners", self.banners, Range{0, 100}, "banners around");
    visit("vehicles", self.vehicles, Range{0, 100}, "parked vehicles");
    visit("uav_shadow", self.uav_shadow, "the UAV's shadow");
  }
  std::vector<std::string> Validate() const;
};

// Plans the recording: everything is made except the images. 'camera' has a mount (the nominal
// one). The same arguments give the same recording. Throws InputError when options are not valid.
RecordingPlan PlanHunt(const HuntSimulationOptions& options, const CameraCalibration& camera,
                       std::uint64_t seed);

}  // namespace kestrel
