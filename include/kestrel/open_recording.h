// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// A recording or a ROS bag by its name, together with the calibration of its camera.
//
// Example:
//   const OpenedSource flight = OpenRecording({.sources = {"flight.bag"}});
//   for (Frame frame; flight.source->Next(&frame);) {
//     std::cout << frame.name << (flight.has_world() ? " has a place\n" : "\n");
//   }

#include "kestrel/io/bags/open_recording.h"  // IWYU pragma: export
