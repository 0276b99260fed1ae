// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/core/base/time.h"

namespace kestrel {

// Image time of time 0 of a simulated flight.
inline constexpr Time kStartTime = TimeFromNanoseconds(100'000'000'000);
inline Time TimeOfFlight(double time_s) { return kStartTime + DurationFromSeconds(time_s); }

}  // namespace kestrel
