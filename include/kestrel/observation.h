// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// A frame together with what a pipeline saw in it: the input of every sink.
//
// Example:
//   const Observation observation;
//   if (const auto* landing = std::get_if<LandingObservation>(&observation.seen)) {
//     std::cout << (landing->report.detection ? "found" : landing->report.reason) << "\n";
//   }

#include "kestrel/flight/session/observation.h"  // IWYU pragma: export
