// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <chrono>

#include "kestrel/core/base/time.h"

namespace kestrel {

// When to send the next message of a steady stream: at a rate, and at once what is news, if the
// next one is nearly due.
class SendSchedule {
 public:
  explicit SendSchedule(double rate_hz) : period_(DurationFromSeconds(1 / rate_hz)) {}

  // Whether one is to be sent at 'now', which then has been.
  bool IsDue(Time now, bool is_news) {
    if (now < due_ - (is_news ? period_ / 2 : Duration::zero())) return false;
    // What was missed is not made up for.
    due_ = std::max(due_ + period_, now + period_ / 2);
    return true;
  }

 private:
  Duration period_;
  Time due_{};
};

}  // namespace kestrel
