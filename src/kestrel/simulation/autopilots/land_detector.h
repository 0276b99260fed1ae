// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/comms/autopilot_rules/autopilot_parameters.h"
#include "kestrel/comms/autopilot_rules/landing_rules.h"

namespace kestrel {

// When an autopilot thinks that it has landed, in any mode: what it feels and what it wants have to
// agree for some seconds.
class LandDetector {
 public:
  // The parameters must outlive it.
  LandDetector(AutopilotFirmware firmware, const AutopilotParameters& parameters)
      : firmware_(firmware), parameters_(parameters) {}

  // After each step: what was flown by 'command'.
  void Observe(const FlightState& state, const SetPoint& command);

  bool has_landed() const { return is_on_ground_ || landed_s() >= 0; }
  // For how long, s; negative: it has not, or never flew.
  double landed_s() const;

 private:
  bool Settles(const FlightState& state, const SetPoint& command) const;

  AutopilotFirmware firmware_;
  const AutopilotParameters& parameters_;
  bool is_on_ground_ = true;  // it has not flown yet
  double settled_s_ = 0;
};

}  // namespace kestrel
