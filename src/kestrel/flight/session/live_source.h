// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "kestrel/core/base/time.h"
#include "kestrel/io/recording/event_source.h"

namespace kestrel {

// What has happened to a live source's frames.
struct CaptureCounters {
  std::uint64_t captured = 0;  // given out
  std::uint64_t missed = 0;    // taken by the camera, but too late for, or lost on the way to, us
  std::uint64_t untimed = 0;   // given out with the time of their arrival, for want of another
  std::uint64_t reopened = 0;  // times that the source came back
};

// Where frames (and poses, of a recording) come from while they happen. All times are those of
// Now(). Next by one thread; the other functions by any.
class LiveSource {
 public:
  virtual ~LiveSource() = default;

  // The next event; nothing when there is none within 'timeout', and when the source is gone: each
  // call then also tries to get it back, not more often than is good for it. EndOfStream when it
  // has ended for good. Does not throw.
  virtual std::optional<Event> Next(Duration timeout) = 0;

  // Why there are no frames, in words; empty as long as the source delivers.
  virtual std::string error() const { return ""; }

  virtual CaptureCounters counters() const = 0;
};

}  // namespace kestrel
