// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/clock_exchange.h"

#include <algorithm>

namespace kestrel {

void ClockExchange::Reset() {
  sync_.Reset();
  started_.reset();
  due_ = {};
  was_answered_ = false;
  answers_ = 0;
}

std::optional<mavlink::Timesync> ClockExchange::Request(Time now) {
  constexpr Duration kHurry = std::chrono::seconds(10);
  constexpr Duration kHurriedly = std::chrono::milliseconds(50);
  constexpr Duration kSteadily = std::chrono::milliseconds(100);
  if (now < due_) return std::nullopt;
  if (!started_) started_ = now;
  due_ = now + (now - *started_ < kHurry ? kHurriedly : kSteadily);
  mavlink::Timesync question;
  question.ts1 = ToNanoseconds(now);
  requested_[question_++ % kQuestions] = question.ts1;
  return question;
}

std::optional<mavlink::Timesync> ClockExchange::Handle(const mavlink::Timesync& message,
                                                       Time received) {
  if (message.tc1 != 0) {
    // Answers to other programs' requests come here, too.
    auto* requested = std::find(requested_.begin(), requested_.end(), message.ts1);
    if (message.ts1 == 0 || requested == requested_.end()) return std::nullopt;
    *requested = 0;
    was_answered_ = true;
    sync_.AddRoundTrip(TimeFromNanoseconds(message.ts1), message.tc1, received);
    return std::nullopt;
  }
  sync_.AddOneWay(message.ts1, received);
  if (!sync_.is_known()) return std::nullopt;
  mavlink::Timesync answer;
  answer.tc1 = sync_.ToRemote(received);
  answer.ts1 = message.ts1;
  ++answers_;
  return answer;
}

void ClockExchange::HandleStamp(std::int64_t remote_ns, Time received) {
  constexpr Duration kPatience = std::chrono::seconds(3);
  if (was_answered_ || !started_ || received - *started_ < kPatience) return;
  sync_.AddOneWay(remote_ns, received);
}

}  // namespace kestrel
