// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/core/base/time.h"

namespace kestrel {

// Maps the stamps of a sender, whose clock has another origin and a drift, to local times: the
// intervals are those of the stamps, the offset is the smallest difference of arrival and stamp.
// The local times are late by the shortest way of a frame, which is constant. The offset may rise
// by the drift of two clocks only, so that a line that gets slower and slower does not delay the
// times. A stamp that jumps is replaced by the arrival; when the stamps stay there, the mapping
// begins anew.
class SenderClock {
 public:
  // Returns the local time of a frame. 'stamp': on the sender's clock; 'arrival': on the local one.
  Time Map(Time stamp, Time arrival);

  bool has_begun() const { return frames_ > 0; }

 private:
  static constexpr int kSettled = 30;

  bool is_settled() const { return frames_ >= kSettled; }
  bool IsOdd(Time stamp, Time arrival) const;
  Time Begin(Time stamp, Time arrival);

  int frames_ = 0;      // since the mapping began
  int odd_ = 0;         // frames in a row whose stamps do not continue those before
  Time stamp_;          // newest that continues them
  Time arrival_;        // of that frame
  Duration offset_{};   // local time minus stamp
  Duration typical_{};  // arrival after the mapped time, a mean
  Time odd_stamp_;      // newest that does not
};

}  // namespace kestrel
