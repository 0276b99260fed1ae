// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kestrel/core/base/random.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/base/violations.h"

namespace kestrel {

// Faults of a link for the messages in both directions.
struct LinkFaultOptions {
  double delay_s = 0;   // of each message
  double jitter_s = 0;  // the delay varies by up to this to both sides; messages stay in order
  double loss = 0;      // part of the messages that are lost
  // Silence in both directions: begins 'down_after_s' after the start (negative: never), lasts
  // 'down_for_s', and is repeated with a period (0: once).
  double down_after_s = -1;
  double down_for_s = 2;
  double down_every_s = 0;

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("delay_s", self.delay_s, "s", "delay of each message, one way");
    visitor("jitter_s", self.jitter_s, "s", "variation of the delay to both sides");
    visitor("loss", self.loss, "1", "part of the messages that is lost");
    visitor("down_after_s", self.down_after_s, "s",
            "time from the start to a silence in both directions; negative: never");
    visitor("down_for_s", self.down_for_s, "s", "duration of the silence");
    visitor("down_every_s", self.down_every_s, "s", "period of the silence; 0: once");
  }
  std::vector<std::string> Validate() const {
    std::vector<std::string> violations;
    RequireIn(delay_s, 0, 10, "delay_s", &violations);
    RequireIn(jitter_s, 0, 10, "jitter_s", &violations);
    RequireIn(loss, 0, 1, "loss", &violations);
    RequireIn(down_after_s, -1, 10000, "down_after_s", &violations);
    RequireIn(down_for_s, 0, 10000, "down_for_s", &violations);
    RequireIn(down_every_s, 0, 10000, "down_every_s", &violations);
    return violations;
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
