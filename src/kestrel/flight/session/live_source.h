// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "kestrel/core/base/time.h"
#include "kestrel/io/recording/event_source.h"

namespace kestrel {

// Counts of a live source's frames.
struct CaptureCounters {
  std::uint64_t captured = 0;  // given out
  std::uint64_t missed = 0;    // taken by the camera, but lost on the way to us or too late
  std::uint64_t refused = 0;   // part of the missed: came to us, but could not be used
  std::uint64_t untimed = 0;   // given out with the time of their arrival, because they have no
                               // other
  std::uint64_t reopened = 0;  // number of times that the source came back
};

// Counts of the events of a flight on their way to the vision.
struct LiveEventCounters {
  std::uint64_t frames = 0;          // given out
  std::uint64_t dropped_frames = 0;  // replaced by a newer frame
  std::uint64_t unposed_frames = 0;  // given out before the pose after them
  std::uint64_t dropped_poses = 0;   // replaced by newer poses
};

// Source of live frames (and of poses, from a recording). All times are those of Now(). Next is
// called by one thread, the other functions by any.
class LiveSource {
 public:
  virtual ~LiveSource() = default;

  // Returns the next event; nothing when none comes within 'timeout', and while the source is gone.
  // Each call then also tries to get it back, not more often than is good for it. EndOfStream when
  // the source has ended for good. Does not throw.
  virtual std::optional<Event> Next(Duration timeout) = 0;

  // Reports why there are no frames; empty as long as the source delivers.
  virtual std::string error() const { return ""; }

  virtual CaptureCounters counters() const = 0;
};

}  // namespace kestrel
