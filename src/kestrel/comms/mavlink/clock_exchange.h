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

// Questions and answers of TIMESYNC with an autopilot, which feed a TimeSync. The autopilot's own
// questions are answered with what its own clock says, as it is known here: so every stamp that
// goes to the autopilot is on its clock, whether it converts stamps by what it learns from the
// answers (PX4, once it trusts them) or takes them as they are.
class ClockExchange {
 public:
  const TimeSync& sync() const { return sync_; }

  // The clock is known from stamps alone.
  bool is_one_way() const { return sync_.is_known() && !was_answered_; }

  // The question to send at 'now', when one is due: 20 per second during the first ten, then 10.
  std::optional<mavlink::Timesync> Ask(Time now);

  // A TIMESYNC of the autopilot; the answer to send, when it is a question and the answer is known.
  std::optional<mavlink::Timesync> Handle(const mavlink::Timesync& message, Time received);

  // Another message said what the autopilot's clock showed as it was sent: all there is for an
  // autopilot that does not know TIMESYNC.
  void HandleStamp(std::int64_t remote_ns, Time received);

  void Reset();

  int answers() const { return answers_; }  // to the autopilot's questions since Reset()

 private:
  static constexpr std::size_t kQuestions = 32;

  TimeSync sync_;
  std::array<std::int64_t, kQuestions> asked_{};  // local times, ns; 0: answered
  std::size_t question_ = 0;
  Time due_{};
  std::optional<Time> started_;
  bool was_answered_ = false;
  int answers_ = 0;
};

}  // namespace kestrel
