// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "kestrel/simulation/autopilot_rules/autopilot_parameters.h"
#include "kestrel/simulation/autopilot_rules/landing_rules.h"
#include "kestrel/simulation/autopilot_rules/px4_target.h"
#include "kestrel/simulation/autopilot_rules/px4_time_sync.h"

namespace kestrel {

// PX4's required precision landing (mode 4/9): without a target it searches before it lands.
class Px4Landing : public LandingRules {
 public:
  // All arguments must outlive this.
  Px4Landing(const AutopilotParameters& parameters, const Px4TimeSync& clock, Announce announce);

  void Handle(const mavlink::LandingTarget& target, const FlightState& state) override {
    target_.Handle(target, state);
  }
  void Handle(const mavlink::TargetRelative& target, const FlightState& state) override {
    target_.Handle(target, state);
  }
  void Estimate(const FlightState& state) override { target_.Estimate(state); }
  void StartLanding(const FlightState& state) override;
  SetPoint Land(const FlightState& state) override;

  enum class Phase { kStart, kApproach, kDescend, kFinal, kSearch, kFallback };
  Phase phase() const { return phase_; }

 private:
  void Enter(Phase phase, const FlightState& state);
  void ObserveTarget(const FlightState& state);
  double AgeOfTarget(const FlightState& state) const;
  bool CanApproach(const FlightState& state) const;
  bool CanDescend(const FlightState& state) const;
  bool IsNearGround(const FlightState& state) const;
  bool IsAbove(const FlightState& state) const;
  void ChoosePhase(const FlightState& state);
  void Approach(const FlightState& state);
  void Descend(const FlightState& state);
  void Search(const FlightState& state);
  bool Sinks() const;
  double ClimbRate(const FlightState& state) const;

  const AutopilotParameters& parameters_;
  Px4Target target_;
  Phase phase_ = Phase::kStart;
  double phase_s_ = 0;               // time in the phase
  double above_s_ = 0;               // time above the target in the approach
  bool is_valid_ = false;            // the target is not older than PLD_BTOUT
  bool is_updated_ = false;          // and was reported since the last step
  Eigen::Vector2d goal_{0, 0};       // place to fly to
  Eigen::Vector2d set_point_{0, 0};  // smoothed place on the way there
  double altitude_ = 0;              // altitude of the approach or of the search
  int searches_ = 0;
};

}  // namespace kestrel
