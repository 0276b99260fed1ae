// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The interface of a live source of frames. A camera of your own implements it.
//
// Example:
//   struct Blank : LiveSource {
//     std::optional<Event> Next(Duration) override {
//       return Frame{.name = "blank", .time = Now(), .image = cv::Mat::zeros(480, 752, CV_8UC1)};
//     }
//     CaptureCounters counters() const override { return {}; }
//   };

#include "kestrel/flight/session/live_source.h"  // IWYU pragma: export
