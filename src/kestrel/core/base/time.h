// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cmath>
#include <cstdint>

namespace kestrel {

// Signed span of time, integer nanoseconds.
using Duration = std::chrono::nanoseconds;

// The clock of a recording or of a sensor. Its epoch is that of the source.
struct SensorClock {
  using rep = std::int64_t;
  using period = std::nano;
  using duration = Duration;
  using time_point = std::chrono::time_point<SensorClock, Duration>;
  static constexpr bool is_steady = false;
};

// Instant on a SensorClock, integer nanoseconds. The time of a frame is the middle of its exposure,
// never its arrival.
using Time = SensorClock::time_point;

inline constexpr Time TimeFromNanoseconds(std::int64_t ns) { return Time(Duration(ns)); }
inline constexpr std::int64_t ToNanoseconds(Time time) { return time.time_since_epoch().count(); }

// Rounds to the nearest nanosecond; 'seconds' must be finite and below 292 years.
inline Duration DurationFromSeconds(double seconds) {
  return Duration(static_cast<std::int64_t>(std::llround(seconds * 1e9)));
}
inline constexpr double ToSeconds(Duration duration) { return 1e-9 * duration.count(); }

// The clock of this computer, which times everything live: Linux' CLOCK_MONOTONIC, since boot. It
// never jumps, and GStreamer's cameras use the same clock.
inline Time Now() {
  return Time(
      std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now().time_since_epoch()));
}

}  // namespace kestrel
