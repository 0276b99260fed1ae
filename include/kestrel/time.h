// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Instants and spans of time in integer nanoseconds, their conversions, and the clock of live
// sources.
//
// Example:
//   const Time captured = TimeFromNanoseconds(1'500'000'000);
//   const Time used = captured + DurationFromSeconds(0.25);
//   const double late_s = ToSeconds(used - captured);  // 0.25

#include "kestrel/core/base/time.h"  // IWYU pragma: export
