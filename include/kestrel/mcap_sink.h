// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Sinks that write an MCAP file for Foxglove, Lichtblick and Rerun.
//
// Example:
//   const CameraCalibration calibration = ReadCalibration("camera.yaml");
//   ObservationSinks sinks;
//   sinks.Add(OpenMcapSink("flight.mcap", /*replace=*/true, *MakeTask("land", TaskOptions()),
//                          calibration, /*further=*/{},
//                          [](const std::string& text) { std::cerr << text << "\n"; }));

#include "kestrel/app/foxglove/mcap_sink.h"  // IWYU pragma: export
