// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "kestrel/simulation/autopilot_rules/ardupilot_target.h"
#include "kestrel/simulation/autopilot_rules/autopilot_parameters.h"
#include "kestrel/simulation/autopilot_rules/landing_rules.h"
#include "kestrel/simulation/autopilots/shaped_path.h"

namespace kestrel {

// ArduCopter's LAND mode with precision landing.
class ArduPilotLanding : public LandingRules {
 public:
  // The parameters must outlive this.
  ArduPilotLanding(const AutopilotParameters& parameters, Announce announce);

  void Handle(const mavlink::LandingTarget& target, const FlightState& state) override;
  void Handle(const mavlink::TargetRelative& target, const FlightState& state) override;
  void Estimate(const FlightState& state) override { target_.Estimate(state); }
  void StartLanding(const FlightState& state) override;
  SetPoint Land(const FlightState& state) override;

  const ArduPilotTarget& target() const { return target_; }

 private:
  bool Hovers() const;
  void ShapePath(const FlightState& state);
  double ClimbRate(const FlightState& state) const;

  const AutopilotParameters& parameters_;
  ArduPilotTarget target_;
  bool had_target_ = false;  // since the mode began
  ShapedPath<2> path_;       // horizontal path that it follows
};

}  // namespace kestrel
