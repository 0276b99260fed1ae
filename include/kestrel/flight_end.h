// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The end of a flight: landed on the pattern or beside it, not landed, given up; and in words.
//
// Example:
//   const FlightEnd end{FlightOutcome::kOnPattern, 0.05};
//   std::cerr << InWords(end) << "\n";  // landed 0.05 m from the centre

#include "kestrel/flight/session/flight_end.h"  // IWYU pragma: export
