// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/core/base/time.h"

namespace kestrel {

// Schedule of a stream of messages: news are sent at once, and a beat fills the time between them.
class SendSchedule {
 public:
  explicit SendSchedule(double rate_hz) : period_(DurationFromSeconds(1 / rate_hz)) {}

  // True when a message is to be sent at 'now'; it then counts as sent. A source of news that is
  // faster than twice the rate is thinned out.
  bool IsDue(Time now, bool is_news) {
    const Time due = is_news ? news_ + period_ / 2 : sent_ + period_;
    if (now < due) return false;
    sent_ = now;
    if (is_news) news_ = now;
    return true;
  }

 private:
  Duration period_;
  Time sent_{}, news_{};  // the last message, and the last one with news
};

}  // namespace kestrel
