// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// A flight as a library: source, pipeline, autopilot, guidance, recorder and sinks in one object.
//
// Example:
//   GstreamerCamera camera("/dev/video0", PaperCamera(), PixelFormat::kGray, {});
//   ObservationSinks sinks;  // add yours
//   LiveSession session({.source = &camera, .calibration = ReadCalibration("camera.yaml"),
//                        .sink = &sinks, .autopilot = "serial:///dev/ttyAMA0:921600"});
//   session.Run([] { return false; });
//   sinks.Finish();

#include "kestrel/flight/onboard/live_session.h"  // IWYU pragma: export
