// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The state of a live session: camera, autopilot, target, recorder and their counts.
//
// Example:
//   struct Watch : ObservationSink {
//     void Take(const Observation&) override {}
//     void Take(const FlightReport& report) override {
//       if (!report.trouble.empty()) std::cerr << report.trouble << "\n";
//     }
//   };

#include "kestrel/flight/session/flight_report.h"  // IWYU pragma: export
