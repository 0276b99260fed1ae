// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/app/console/messages/console_feed.h"
#include "kestrel/core/base/time.h"
#include "kestrel/flight/session/session_event.h"

namespace kestrel {

// States and messages that the autopilot reported during a recorded flight.
struct RecordedAutopilot {
  struct State {
    Time since;
    ConsoleVehicle vehicle;
  };
  std::vector<State> states;         // in order of time; empty: nothing was recorded
  std::vector<SessionEvent> events;  // texts, changes of mode; in order of time
  std::string fault;                 // why a part, or all, is not there; empty: all is

  // The state at a time. Needs a state.
  const ConsoleVehicle& At(Time time) const;
};

// Reads mavlink.tlog beside the only source, if there is one. 'begin', 'end': the times of the
// first and the last image, by which the times of the log become times of the recording. Throws
// InputError when the file cannot be read.
RecordedAutopilot ReadRecordedAutopilot(const std::vector<std::string>& sources, Time begin,
                                        Time end);

}  // namespace kestrel
