// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// A recording as a live source, played at the pace at which it was flown.
//
// Example:
//   RealtimeReplay replay([] { return OpenSource({"flight"}); }, /*clock_offset=*/Duration::zero(),
//                         /*is_looped=*/false);
//   LiveSession session({.source = &replay, .calibration = ReadCalibration("camera.yaml")});
//   session.Run([] { return false; });

#include "kestrel/flight/onboard/realtime_replay.h"  // IWYU pragma: export
