// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// A session over a recording: every frame through the vision, every result to a sink.
//
// Example:
//   struct Counter : ObservationSink {
//     void Take(const Observation&) override { ++frames; }
//     int frames = 0;
//   };
//   const OpenedSource opened = OpenRecording({.sources = {"flight.bag"}});
//   LandingRun landing(opened, LandingPipelineOptions(), /*altitude_m=*/std::nullopt);
//   Counter counter;
//   RunRecording(opened, &landing, &counter, [](std::size_t) { return true; });
//   std::cout << counter.frames << " frames, " << landing.Found() << "\n";

#include "kestrel/flight/session/recorded_session.h"  // IWYU pragma: export
