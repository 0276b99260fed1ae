// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/flight_options.h"

#include "kestrel/core/base/violations.h"

namespace kestrel {

std::vector<std::string> FlightOptions::Validate() const {
  std::vector<std::string> violations;
  RequireIn(rate_hz, 1, 400, "rate_hz", &violations);
  RequireIn(link_delay_s, -1, 2, "link_delay_s", &violations);
  RequirePositive(source_timeout_s, "source_timeout_s", &violations);
  RequirePositive(autopilot_timeout_s, "autopilot_timeout_s", &violations);
  AddViolations("target", target.Validate(), &violations);
  AddViolations("messages", messages.Validate(), &violations);
  AddViolations("guidance", guidance.Validate(), &violations);
  AddViolations("guard", guard.Validate(), &violations);
  AddViolations("events", events.Validate(), &violations);
  AddViolations("vision_thread", vision_thread.Validate(), &violations);
  return violations;
}

}  // namespace kestrel
