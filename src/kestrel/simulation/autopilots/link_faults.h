// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>
#include <string>
#include <utility>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/base/random.h"
#include "kestrel/core/base/time.h"

namespace kestrel {

// Faults of a link for the messages in both directions.
struct LinkFaultOptions {
  double delay_s = 0;
  double jitter_s = 0;
  double loss = 0;
  double down_after_s = -1;
  double down_for_s = 2;
  double down_every_s = 0;

  static void Visit(auto& self, auto&& visit) {
    visit("delay_s", self.delay_s, Range{0, 10}, "delay of each message, one way");
    visit("jitter_s", self.jitter_s, Range{0, 10}, "variation of the delay to both sides");
    visit("loss", self.loss, Range{0, 1}, "part of the messages that is lost");
    visit("down_after_s", self.down_after_s, Range{-1, 10000},
          "time from the start to a silence in both directions; negative: never");
    visit("down_for_s", self.down_for_s, Range{0, 10000}, "duration of the silence");
    visit("down_every_s", self.down_every_s, Range{0, 10000}, "period of the silence; 0: once");
  }
  bool IsDown(double since_start_s) const {
    double since_s = since_start_s - down_after_s;
    if (down_after_s < 0 || since_s < 0) return false;
    if (down_every_s > 0) since_s = std::fmod(since_s, down_every_s);
    return since_s < down_for_s;
  }
};

// One direction of a link: messages come out later, in order, or not at all.
template <class Message>
class DelayLine {
 public:
  DelayLine(const LinkFaultOptions& options, const Random& random)
      : options_(options), random_(random) {}

  void Push(Time now, Message message) {
    if (random_.Chance(options_.loss)) return;
    const double delay_s = options_.delay_s + random_.Uniform(-1, 1) * options_.jitter_s;
    last_due_ = std::max(last_due_, now + DurationFromSeconds(std::max(delay_s, 0.0)));
    messages_.emplace_back(last_due_, std::move(message));
  }

  // Returns the next message that has arrived by 'now'.
  std::optional<Message> Pop(Time now) {
    if (messages_.empty() || messages_.front().first > now) return std::nullopt;
    std::optional<Message> message = std::move(messages_.front().second);
    messages_.pop_front();
    return message;
  }

 private:
  LinkFaultOptions options_;
  Random random_;
  Time last_due_;
  std::deque<std::pair<Time, Message>> messages_;
};

}  // namespace kestrel
