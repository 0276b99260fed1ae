// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>

#include "kestrel/comms/autopilot_rules/autopilot_parameters.h"
#include "kestrel/core/base/time.h"
#include "kestrel/simulation/autopilots/guided_rules.h"

namespace kestrel {

// PX4's OFFBOARD mode by velocities, without a transmitter. It needs a stream of set-points before
// it begins, and ends it by the parameters of its failsafe. It does not compensate the air's drag:
// its velocity control has to. Set-points of places are not modelled: they are dropped.
class Px4Offboard : public GuidedRules {
 public:
  // The parameters must outlive it.
  Px4Offboard(const AutopilotParameters& parameters, Announce announce);

  void Handle(const mavlink::SetPositionTargetLocalNed& message, const FlightState& state,
              bool is_guided) override;
  bool IsAvailable(const FlightState& state) const override;
  void Start(const FlightState& state) override;
  FlightCommand Fly(const FlightState& state) override;
  std::optional<FlightMode> LossAction(const FlightState& state) const override;

 private:
  double SilentFor(const FlightState& state) const;
  Eigen::Vector3d WithinLimits(const Eigen::Vector3d& velocity) const;
  Eigen::Vector3d ControlVelocity(const FlightState& state, const Eigen::Vector3d& velocity);

  const AutopilotParameters& parameters_;
  Announce announce_;
  SetPoint wanted_;
  std::optional<double> turn_rate_;  // ENU, rad/s
  std::optional<Time> first_told_;   // of the stream that goes on
  Time told_{};                      // last
  Eigen::Vector3d integral_{0, 0, 0};
  Eigen::Vector3d last_velocity_{0, 0, 0};
  Eigen::Vector3d change_{0, 0, 0};  // of the velocity, m/s^2
};

}  // namespace kestrel
