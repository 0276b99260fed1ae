// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// A recording as a live source, played at the pace at which it was flown.
//
// Example:
//   const OpenedLiveSource flight{
//       .source = std::make_unique<RealtimeReplay>([] { return OpenSource({"flight"}); },
//                                                  /*clock_offset=*/Duration::zero(),
//                                                  /*is_looped=*/false),
//       .calibration = ReadCalibration("camera.yaml")};
//   MakeSession(flight, LandTask({}))->Run();

#include "kestrel/flight/onboard/realtime_replay.h"  // IWYU pragma: export
