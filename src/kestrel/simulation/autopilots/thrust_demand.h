// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "kestrel/simulation/autopilot_rules/autopilot_parameters.h"
#include "kestrel/simulation/autopilot_rules/landing_rules.h"

namespace kestrel {

// Thrust and lean that an autopilot commands while the UAV stands on a deck that carries it. The
// velocity control cannot change the motion of the deck. Its integrators therefore wind up until
// the lean is at its limit and the throttle at its minimum. Land detectors judge by both.
class ThrustDemand {
 public:
  // The parameters must outlive this.
  ThrustDemand(AutopilotFirmware firmware, const AutopilotParameters& parameters);

  // Called after each step; 'command' was flown.
  void Observe(const FlightState& state, const FlightCommand& command);

  double lean() const { return lean_; }          // from the vertical, rad
  double throttle() const { return throttle_; }  // thrust as a part of the one that hovers, not < 0

 private:
  void ObserveHorizontal(const FlightState& state, const FlightCommand& command);
  void ObserveVertical(const FlightState& state, const SetPoint& command);

  struct Gains {
    double p;
    double i;
  };
  Gains horizontal_;
  Gains vertical_;
  double max_lean_;
  Eigen::Vector2d horizontal_integral_{0, 0};
  double vertical_integral_ = 0;
  double lean_ = 0;
  double throttle_ = 1;
};

}  // namespace kestrel
