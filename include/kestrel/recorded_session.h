// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// A session over a recording: every frame through the vision of a task, every result to the sinks.
//
// Example:
//   struct Counter : ObservationSink {
//     void Take(const Observation&) override { ++frames; }
//     int frames = 0;
//   };
//   const OpenedSource opened = OpenRecording({.sources = {"flight.bag"}});
//   RecordedSession session(opened, *MakeTask("land", TaskOptions()), /*altitude_m=*/std::nullopt);
//   const Counter* const counter = session.sinks().Add(std::make_unique<Counter>());
//   session.AddTables({.folder = "results"});
//   session.Run([](std::size_t) { return true; });
//   std::cout << counter->frames << " frames\n" << session.Summary();

#include "kestrel/flight/session/recorded_session.h"  // IWYU pragma: export
