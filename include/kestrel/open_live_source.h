// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// A live source by its name, as the command `kestrel fly` takes it.
//
// Example:
//   const OpenedLiveSource camera = OpenLiveSource(
//       {.recording = {.sources = {"/dev/video0"}, .camera = "camera.yaml"}}, {});
//   LiveSession session({.source = camera.source.get(), .calibration = camera.calibration});
//   session.Run([] { return false; });

#include "kestrel/flight/onboard/open_live_source.h"  // IWYU pragma: export
