// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/flight/onboard/flight_options.h"
#include "kestrel/simulation/autopilots/simulated_autopilot.h"
#include "kestrel/simulation/autopilots/simulated_camera.h"

namespace kestrel {

// The options of `kestrel fly`.
struct FlyOptions : FlightOptions {
  std::string source;
  SimulatedCameraOptions sim_camera;
  SimulatedAutopilotOptions sim_autopilot;
  int sim_seed = 1;
  std::string keep_folder = "kept";

  static void Visit(auto& self, auto&& visit) {
    visit("source", self.source, "camera or recording, where the command line has no SOURCE");
    FlightOptions::Visit(self, visit);
    visit.Group("sim_camera", self.sim_camera);
    visit.Group("sim_autopilot", self.sim_autopilot);
    visit("sim_seed", self.sim_seed, "seed of the simulated world and autopilot");
    visit("keep_folder", self.keep_folder,
          "folder for the recordings and snapshots that the console's page asks for");
  }
};

}  // namespace kestrel
