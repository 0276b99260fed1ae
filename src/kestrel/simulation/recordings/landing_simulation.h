// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kestrel/core/camera/calibration.h"
#include "kestrel/simulation/recordings/recording_plan.h"
#include "kestrel/simulation/recordings/second_camera.h"
#include "kestrel/simulation/recordings/simulated_flight.h"
#include "kestrel/simulation/recordings/stills_simulation.h"
#include "kestrel/simulation/scene/landing_scene.h"
#include "kestrel/simulation/vehicle/landing_flight.h"

namespace kestrel {

// A simulated flight over the landing pattern, from the motion to the sensor.
struct LandingSimulationOptions : LandingSceneOptions {
  FlightRecordingOptions recording;
  StillsOptions stills;
  LandingFlightOptions flight;
  SecondCameraOptions second;

  static void Visit(auto& self, auto&& visit) {
    visit.Group(self.recording);
    visit.Group("stills", self.stills);
    visit.Group("flight", self.flight);
    visit.Group("second", self.second);
    LandingSceneOptions::Visit(self, visit);
  }
  std::vector<std::string> Validate() const;
};

// Plans a flight, or stills, as a recording: everything is made except the images. 'camera' has a
// mount (the nominal one). The same arguments give the same recording. Throws InputError when
// options are not valid.
RecordingPlan PlanLanding(const LandingSimulationOptions& options, const CameraCalibration& camera,
                          std::uint64_t seed);

}  // namespace kestrel
