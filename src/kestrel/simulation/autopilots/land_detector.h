// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "kestrel/simulation/autopilot_rules/autopilot_parameters.h"
#include "kestrel/simulation/autopilot_rules/landing_rules.h"
#include "kestrel/simulation/autopilots/thrust_demand.h"

namespace kestrel {

// Decides when an autopilot believes that it has landed, in any mode, by the rules of its own
// detector: of the rotors, of the motion and of the commands.
class LandDetector {
 public:
  // The parameters must outlive this.
  LandDetector(AutopilotFirmware firmware, const AutopilotParameters& parameters);

  // Called after each step; 'command' was flown.
  void Observe(const FlightState& state, const FlightCommand& command);

  bool has_landed() const { return is_on_ground_ || landed_s_ >= 0; }
  // Time since it has landed, s; negative: it has not, or it never flew.
  double landed_s() const { return landed_s_; }

 private:
  void ObserveAcceleration(const FlightState& state);
  bool ArduPilotSettles(const FlightState& state, const FlightCommand& command) const;
  bool Px4Settles(const FlightState& state, const FlightCommand& command) const;

  AutopilotFirmware firmware_;
  const AutopilotParameters& parameters_;
  ThrustDemand demand_;
  Eigen::Vector3d last_velocity_{0, 0, 0};
  Eigen::Vector3d acceleration_{0, 0, 0};  // through a low pass of 1 Hz
  bool is_on_ground_ = true;               // it has not flown yet
  double settled_s_ = 0;
  double landed_s_ = -1;
};

}  // namespace kestrel
