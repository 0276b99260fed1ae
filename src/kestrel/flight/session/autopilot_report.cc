// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/session/autopilot_report.h"

#include <fmt/format.h>

#include "kestrel/comms/mavlink/mavlink_enums.h"

namespace kestrel {

void UpdateState(const Autopilot& autopilot, Time now, AutopilotState* state) {
  state->is_here = autopilot.is_here();
  state->is_armed = autopilot.is_armed();
  state->is_landing = state->is_armed && (autopilot.is_landing_mode() || autopilot.is_descent());
  if (state->is_here) {
    state->mode = autopilot.mode_name();
    state->waits.clear();
  }
  if (const auto battery = autopilot.battery()) {
    state->battery_v = battery->voltage_v;
    state->battery_remaining = battery->remaining;
  }
  if (const auto& gnss = autopilot.status().gnss()) {
    state->gnss_fix = gnss->fix;
    state->satellites = gnss->satellites;
  }
  state->has_good_position = autopilot.is_position_good(now);
}

std::string WordsOfAutopilot(std::string_view text) { return fmt::format("autopilot: {}", text); }

EventLevel LevelOf(std::uint8_t severity) {
  if (severity <= mavlink::kSeverityError) return EventLevel::kError;
  return severity <= mavlink::kSeverityWarning ? EventLevel::kWarning : EventLevel::kInfo;
}

}  // namespace kestrel
