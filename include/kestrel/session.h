// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// A source, the vision of a task, and sinks in one object. Over a recording, with options of the
// task:
//
// Example:
//   LandingPipelineOptions options;
//   options.target.kind = "apriltag";
//   const OpenedSource recording = OpenRecording({.sources = {"flight.bag"}});
//   const auto session = MakeSession(recording, LandTask(options), {.output = "results"});
//   session->Run();
//   std::cout << session->Summary();
//
// A flight, with an autopilot that is guided:
//
// Example:
//   const OpenedLiveSource camera = OpenLiveSource(
//       {.recording = {.sources = {"/dev/video0"}, .camera = "camera.yaml"}}, {});
//   SessionOptions options{.autopilot = "serial:///dev/ttyAMA0:921600", .guides = true};
//   options.flight.guidance.search_altitude_m = 8;
//   const auto session = MakeSession(camera, LandTask({}), options);
//   session->Run();

#include "kestrel/flight/onboard/session.h"  // IWYU pragma: export
