// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "kestrel/comms/mavlink/messages.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/simulation/autopilot_rules/autopilot_parameters.h"
#include "kestrel/simulation/autopilot_rules/landing_rules.h"
#include "kestrel/simulation/autopilot_rules/position_velocity_filter.h"
#include "kestrel/simulation/autopilot_rules/px4_time_sync.h"

namespace kestrel {

// PX4's estimate of the target: from LANDING_TARGET (an absolute place, used as it arrives) or,
// with VTE_EN, from TARGET_RELATIVE, which it filters.
class Px4Target {
 public:
  // A target in the form that PX4's precision landing uses.
  struct Place {
    Eigen::Vector3d in_world{0, 0, 0};
    Eigen::Vector2d velocity{0, 0};  // m/s; only the vision target estimator estimates one
    std::int64_t stamp_us = 0;       // on the autopilot's own clock
  };

  // All arguments must outlive this.
  Px4Target(const AutopilotParameters& parameters, const Px4TimeSync& clock, Announce announce);

  void Handle(const mavlink::LandingTarget& target, const FlightState& state);
  void Handle(const mavlink::TargetRelative& target, const FlightState& state);
  void Estimate(const FlightState& state);

  // The newest place. TakeUpdated() is true when there is a new one since its last call.
  const std::optional<Place>& place() const { return place_; }
  bool TakeUpdated();

 private:
  bool uses_vision_estimator() const { return parameters_["VTE_EN"] != 0; }
  std::optional<Eigen::Vector3d> InWorld(const mavlink::TargetRelative& target,
                                         const RigidTransform& world_from_body) const;
  void Fuse(const Eigen::Vector3d& in_world, const Eigen::Vector3d& sigma,
            const FlightState& state);

  const AutopilotParameters& parameters_;
  const Px4TimeSync& clock_;
  Announce announce_;
  PoseHistory poses_;  // on the autopilot's own clock
  std::optional<Place> place_;
  bool is_updated_ = false;
  std::array<PositionVelocityFilter, 3> filters_;  // filters of the target's position in the world
  bool is_filtering_ = false;
  std::int64_t fused_us_ = 0;
  int outliers_ = 0;  // in a row
  std::int64_t reported_old_us_ = 0;
};

}  // namespace kestrel
