// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <chrono>

#include "kestrel/core/base/time.h"

namespace kestrel {

// Schedule of a stream of messages at a steady rate. News are sent at once if the next message is
// nearly due.
class SendSchedule {
 public:
  explicit SendSchedule(double rate_hz) : period_(DurationFromSeconds(1 / rate_hz)) {}

  // True when a message is to be sent at 'now'; it then counts as sent.
  bool IsDue(Time now, bool is_news) {
    if (now < due_ - (is_news ? period_ / 2 : Duration::zero())) return false;
    // Missed messages are not made up for.
    due_ = std::max(due_ + period_, now + period_ / 2);
    return true;
  }

 private:
  Duration period_;
  Time due_{};
};

}  // namespace kestrel
