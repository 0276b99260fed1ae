// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

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
  std::string source;  // that is flown with where the command line names none
  FlightOptions flight;
  GstreamerCameraOptions camera;
  // Controls the exposure by the brightness of the images, for cameras that cannot do it
  // themselves.
  bool control_exposure = false;
  ExposureOptions exposure;
  ConnectionOptions link;
  AutopilotOptions autopilot;
  FlightRecorderOptions recorder;
  SimulatedCameraOptions sim_camera;
  SimulatedAutopilotOptions sim_autopilot;
  int sim_seed = 1;
  std::string keep_folder = "kept";  // for recordings and snapshots that the page asks for

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("source", self.source, "", "camera or recording, where the command line has no SOURCE");
    FlightOptions::Visit(self.flight, visitor);
    visitor.Group("camera", self.camera);
    visitor("control_exposure", self.control_exposure, "",
            "the camera's exposure is set by the brightness of its images");
    visitor.Group("exposure", self.exposure);
    visitor.Group("link", self.link);
    visitor.Group("autopilot", self.autopilot);
    visitor.Group("recorder", self.recorder);
    visitor.Group("sim_camera", self.sim_camera);
    visitor.Group("sim_autopilot", self.sim_autopilot);
    visitor("sim_seed", self.sim_seed, "", "seed of the simulated world and autopilot");
    visitor("keep_folder", self.keep_folder, "",
            "folder for the recordings and snapshots that the console's page asks for");
  }
  std::vector<std::string> Validate() const;
};

}  // namespace kestrel
