// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <deque>
#include <optional>

#include <Eigen/Geometry>

#include "kestrel/comms/mavlink/messages.h"
#include "kestrel/simulation/autopilot_rules/autopilot_parameters.h"
#include "kestrel/simulation/autopilot_rules/landing_rules.h"
#include "kestrel/simulation/autopilot_rules/position_velocity_filter.h"

namespace kestrel {

// ArduPilot's estimate of the target from LANDING_TARGET (AC_PrecLand, EST_TYPE 0 and 1): which
// messages it uses, how it dates them by PLND_LAG, when it trusts them, and where it believes the
// target to be.
class ArduPilotTarget {
 public:
  ArduPilotTarget(const AutopilotParameters& parameters, Announce announce);

  void Handle(const mavlink::LandingTarget& target, const FlightState& state);
  void Estimate(const FlightState& state);

  bool is_acquired() const { return is_acquired_; }

  // Horizontal vector from the body to the target in the world, and its rate; m and m/s. Valid
  // while the target is acquired.
  const Eigen::Vector2d& position() const { return position_; }
  const Eigen::Vector2d& velocity() const { return velocity_; }
  // Depth of the newest measurement below the body, m.
  double depth() const { return depth_; }

 private:
  // Readings of the inertial unit in one step.
  struct InertialSample {
    Time time;
    double step_s;
    Eigen::Quaterniond world_from_body;
    Eigen::Vector3d velocity;
    Eigen::Vector3d velocity_change;
    double rate;  // rad/s
  };

  std::optional<Eigen::Vector3d> LineOfSight(const mavlink::LandingTarget& target);
  void Remember(const FlightState& state);
  std::optional<Eigen::Vector3d> TakeMeasurement(Time now, const Eigen::Quaterniond& attitude);
  void EstimateRaw(const std::optional<Eigen::Vector3d>& measurement, Time now);
  void EstimateFiltered(const std::optional<Eigen::Vector3d>& measurement, Time now);
  void StartFilter(const Eigen::Vector3d& measurement, double variance, Time now);
  void FuseMeasurement(const Eigen::Vector3d& measurement, double variance, Time now);
  void CheckStart(Time now);
  void CheckTimeout(Time now);
  void PredictOutput();

  const AutopilotParameters& parameters_;
  Announce announce_;
  std::deque<InertialSample> history_;              // oldest first; the oldest is PLND_LAG old
  std::optional<Eigen::Vector3d> sighted_in_body_;  // not yet used, m
  std::optional<Eigen::Vector3d> sighted_in_world_;
  Time sighted_at_;
  bool reported_wrong_frame_ = false;
  bool is_started_ = false;
  bool is_acquired_ = false;
  int outliers_ = 0;
  Time started_at_;
  Time updated_at_;
  std::array<PositionVelocityFilter, 2> filters_;  // east, north
  Eigen::Vector2d raw_position_{0, 0};
  Eigen::Vector2d raw_velocity_{0, 0};
  Eigen::Vector2d position_{0, 0};
  Eigen::Vector2d velocity_{0, 0};
  double depth_ = 0;
};

}  // namespace kestrel
