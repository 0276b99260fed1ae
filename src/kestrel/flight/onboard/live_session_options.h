// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "kestrel/comms/mavlink/autopilot.h"
#include "kestrel/comms/mavlink/connection.h"
#include "kestrel/core/camera/exposure_controller.h"
#include "kestrel/flight/onboard/flight_options.h"
#include "kestrel/flight/onboard/flight_recorder.h"

namespace kestrel {

// All options of a LiveSession but those of its task.
struct LiveSessionOptions {
  FlightOptions flight;
  ConnectionOptions link;
  AutopilotOptions autopilot;
  FlightRecorderOptions recorder;
  // Exposure that keeps the image right; nothing: the camera does that itself.
  std::optional<ExposureOptions> exposure;
  // Height of the camera above the target or the ground, where there are no poses.
  std::optional<double> altitude_m = {};
};

}  // namespace kestrel
