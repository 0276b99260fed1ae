// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "kestrel/comms/mavlink/autopilot.h"
#include "kestrel/flight/session/flight_report.h"
#include "kestrel/flight/session/session_event.h"

namespace kestrel {

// Sets what the autopilot itself has reported by 'now'.
void UpdateState(const Autopilot& autopilot, Time now, AutopilotState* state);

// A text of the autopilot (STATUSTEXT) as the user gets it.
std::string WordsOfAutopilot(std::string_view text);
EventLevel LevelOf(std::uint8_t severity);

}  // namespace kestrel
