// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>

#include "kestrel/core/base/time.h"
#include "kestrel/simulation/autopilot_rules/autopilot_parameters.h"
#include "kestrel/simulation/autopilots/guided_rules.h"
#include "kestrel/simulation/autopilots/heading_control.h"

namespace kestrel {

// PX4's OFFBOARD mode with velocities, places, or accelerations alone, without a transmitter. It
// needs a stream of set-points before it begins, and its failsafe parameters decide its end. It
// does not compensate the air's drag: its velocity control has to.
class Px4Offboard : public GuidedRules {
 public:
  // The parameters must outlive this. 'thrust_error': part by which its hover thrust is too high,
  // which accelerations alone do not make up for. 'sag_per_s': part of the thrust that the battery
  // loses in a second of the mode.
  Px4Offboard(const AutopilotParameters& parameters, double thrust_error, double sag_per_s,
              Announce announce);

  void Handle(const mavlink::SetPositionTargetLocalNed& message, const FlightState& state,
              bool is_guided) override;
  // Attitudes are not modelled: they are dropped.
  void Handle(const mavlink::SetAttitudeTarget& /*message*/, const FlightState& /*state*/,
              bool /*is_guided*/) override {}
  bool IsAvailable(const FlightState& state) const override;
  bool NeedsPosition() const override { return !is_acceleration_; }
  void Start(const FlightState& state) override;
  FlightCommand Fly(const FlightState& state) override;
  std::optional<FlightMode> LossAction(const FlightState& state) const override;

 private:
  void TakeStream(const FlightState& state);
  FlightCommand Accelerate(const FlightState& state);
  double SilentFor(const FlightState& state) const;
  Eigen::Vector3d WantedVelocity(const FlightState& state) const;
  Eigen::Vector3d WithinLimits(const Eigen::Vector3d& velocity) const;
  Eigen::Vector3d ControlVelocity(const FlightState& state, const Eigen::Vector3d& velocity);

  const AutopilotParameters& parameters_;
  double thrust_error_, sag_per_s_;
  Time started_{};
  Announce announce_;
  bool is_acceleration_ = false;  // it flies by an acceleration alone
  SetPoint wanted_;
  std::optional<double> turn_rate_;  // ENU, rad/s
  HeadingControl heading_;
  std::optional<Time> stream_begin_;  // beginning of the present stream
  Time reported_{};                   // time of the last one
  Eigen::Vector3d integral_{0, 0, 0};
  Eigen::Vector3d last_velocity_{0, 0, 0};
  Eigen::Vector3d change_{0, 0, 0};  // derivative of the velocity, m/s^2
};

}  // namespace kestrel
