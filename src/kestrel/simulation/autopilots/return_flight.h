// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/simulation/autopilot_rules/autopilot_parameters.h"
#include "kestrel/simulation/autopilot_rules/landing_rules.h"

namespace kestrel {

// RTL, simplified: up to the altitude of returning, straight to the origin, and down there.
class ReturnFlight {
 public:
  // The parameters must outlive this.
  ReturnFlight(AutopilotFirmware firmware, const AutopilotParameters& parameters);

  void Start(const FlightState& state);
  SetPoint Fly(const FlightState& state);

 private:
  enum class Leg { kUp, kHome, kDown };

  double SinkAt(double height_m) const;

  const AutopilotParameters& parameters_;
  const char* altitude_;  // names of parameters
  const char* speed_;
  const char* sink_;
  Leg leg_ = Leg::kUp;
  Eigen::Vector2d from_{0, 0};
};

}  // namespace kestrel
