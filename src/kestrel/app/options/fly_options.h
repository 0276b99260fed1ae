// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/comms/mavlink/autopilot.h"
#include "kestrel/comms/mavlink/connection.h"
#include "kestrel/core/camera/exposure_controller.h"
#include "kestrel/flight/onboard/flight_program.h"
#include "kestrel/flight/onboard/flight_recorder.h"
#include "kestrel/flight/onboard/gstreamer_camera.h"
#include "kestrel/simulation/autopilots/simulated_autopilot.h"
#include "kestrel/simulation/autopilots/simulated_camera.h"

namespace kestrel {

// The options of `kestrel fly`.
struct FlyOptions {
  std::string source;
  FlightOptions flight;
  GstreamerCameraOptions camera;
  bool control_exposure = false;
  ExposureOptions exposure;
  ConnectionOptions link;
  AutopilotOptions autopilot;
  FlightRecorderOptions recorder;
  SimulatedCameraOptions sim_camera;
  SimulatedAutopilotOptions sim_autopilot;
  int sim_seed = 1;
  std::string keep_folder = "kept";

  static void Visit(auto& self, auto&& visit) {
    visit("source", self.source, "camera or recording, where the command line has no SOURCE");
    visit.Group(self.flight);
    visit.Group("camera", self.camera);
    visit("control_exposure", self.control_exposure,
          "the camera's exposure is set by the brightness of its images");
    visit.Group("exposure", self.exposure);
    visit.Group("link", self.link);
    visit.Group("autopilot", self.autopilot);
    visit.Group("recorder", self.recorder);
    visit.Group("sim_camera", self.sim_camera);
    visit.Group("sim_autopilot", self.sim_autopilot);
    visit("sim_seed", self.sim_seed, "seed of the simulated world and autopilot");
    visit("keep_folder", self.keep_folder,
          "folder for the recordings and snapshots that the console's page requests");
  }
};

}  // namespace kestrel
