// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "kestrel/comms/mavlink/messages.h"
#include "kestrel/comms/mavlink/time_sync.h"
#include "kestrel/core/base/time.h"

namespace kestrel {

// Requests and answers of TIMESYNC with an autopilot, which feed a TimeSync. The autopilot's own
// requests are answered with its own clock's time, as it is known here. Every stamp to the
// autopilot is therefore on its clock, whether it converts stamps by the answers (PX4, once it
// trusts them) or takes them as they are.
class ClockExchange {
 public:
  const TimeSync& sync() const { return sync_; }

  // True when the clock is known from stamps alone.
  bool is_one_way() const { return sync_.is_known() && !was_answered_; }

  // Returns the request to send at 'now', if one is due: 20 per second for the first ten, then 10
  // per second.
  std::optional<mavlink::Timesync> Request(Time now);

  // Takes a TIMESYNC of the autopilot. Returns the answer to send, if it is a request and the
  // answer is known.
  std::optional<mavlink::Timesync> Handle(const mavlink::Timesync& message, Time received);

  // Takes the autopilot's clock from another message, at the time of its sending: the only source
  // for an autopilot that does not know TIMESYNC.
  void HandleStamp(std::int64_t remote_ns, Time received);

  void Reset();

  int answers() const { return answers_; }  // to the autopilot's requests since Reset()

 private:
  static constexpr std::size_t kQuestions = 32;

  TimeSync sync_;
  std::array<std::int64_t, kQuestions> requested_{};  // local times, ns; 0: answered
  std::size_t question_ = 0;
  Time due_{};
  std::optional<Time> started_;
  bool was_answered_ = false;
  int answers_ = 0;
};

}  // namespace kestrel
