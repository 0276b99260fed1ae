// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "kestrel/core/base/time.h"
#include "kestrel/simulation/autopilot_rules/autopilot_parameters.h"
#include "kestrel/simulation/autopilots/guided_rules.h"
#include "kestrel/simulation/autopilots/heading_control.h"
#include "kestrel/simulation/autopilots/set_point_reading.h"
#include "kestrel/simulation/autopilots/shaped_path.h"

namespace kestrel {

// ArduCopter's GUIDED mode with velocities, with or without accelerations, and with an attitude and
// a climb rate. Position set-points are
// not modelled: it stops, as for a set-point that it refuses.
class ArduPilotGuided : public GuidedRules {
 public:
  // The parameters must outlive this.
  explicit ArduPilotGuided(const AutopilotParameters& parameters);

  void Handle(const mavlink::SetPositionTargetLocalNed& message, const FlightState& state,
              bool is_guided) override;
  void Handle(const mavlink::SetAttitudeTarget& message, const FlightState& state,
              bool is_guided) override;
  bool IsAvailable(const FlightState& /*state*/) const override { return true; }
  void Start(const FlightState& state) override;
  FlightCommand Fly(const FlightState& state) override;
  // Without set-points it stays in the mode and stops.
  std::optional<FlightMode> LossAction(const FlightState& /*state*/) const override {
    return std::nullopt;
  }

 private:
  Eigen::Vector2d ControlVelocity(const FlightState& state, const Eigen::Vector2d& way,
                                  const Eigen::Vector2d& error);
  void Follow(const FlightState& state);

  std::optional<double> Heading(const FlightState& state);
  FlightCommand FlyAttitude(const FlightState& state);

  const AutopilotParameters& parameters_;
  std::optional<AttitudeOrder> attitude_;  // nothing: it flies by velocities
  SetPoint wanted_;
  std::optional<double> turn_rate_;  // ENU, rad/s
  HeadingControl heading_;
  std::optional<Time> reported_;  // time of the last one; nothing: it has to stop
  ShapedPath<2> horizontal_;
  ShapedPath<2>::Limit limit_;
  ShapedPath<1> vertical_;
  // Of the horizontal velocity control, m/s^2.
  Eigen::Vector2d integral_{0, 0};
  Eigen::Vector2d derivative_{0, 0};
  std::optional<Eigen::Vector2d> last_error_;
};

}  // namespace kestrel
