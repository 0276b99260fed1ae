// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/comms/autopilot_rules/autopilot_parameters.h"
#include "kestrel/comms/autopilot_rules/landing_rules.h"

namespace kestrel {

// Decides when an autopilot believes that it has landed, in any mode: measurements and commands
// have to agree for some seconds.
class LandDetector {
 public:
  // The parameters must outlive this.
  LandDetector(AutopilotFirmware firmware, const AutopilotParameters& parameters)
      : firmware_(firmware), parameters_(parameters) {}

  // Called after each step; 'command' was flown.
  void Observe(const FlightState& state, const SetPoint& command);

  bool has_landed() const { return is_on_ground_ || landed_s() >= 0; }
  // Time since it has landed, s; negative: it has not, or it never flew.
  double landed_s() const;

 private:
  bool Settles(const FlightState& state, const SetPoint& command) const;

  AutopilotFirmware firmware_;
  const AutopilotParameters& parameters_;
  bool is_on_ground_ = true;  // it has not flown yet
  double settled_s_ = 0;
};

}  // namespace kestrel
