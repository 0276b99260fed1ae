// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The landing pipeline as the vision of a session over a recording.
//
// Example:
//   const OpenedSource opened =
//       OpenRecording({.sources = {"flight.mp4"}, .camera = "camera.yaml"});
//   LandingRun landing(opened, LandingPipelineOptions(), /*altitude_m=*/5);
//   Frame frame;
//   opened.source->Next(&frame);
//   const Observation first = landing.Process(frame);

#include "kestrel/flight/session/landing_run.h"  // IWYU pragma: export
