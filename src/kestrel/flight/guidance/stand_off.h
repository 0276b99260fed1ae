// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>

#include "kestrel/flight/guidance/follow_options.h"

namespace kestrel {

// The horizontal motion of a point in the world.
struct PlaneMotion {
  Eigen::Vector2d position{0, 0};      // m
  Eigen::Vector2d velocity{0, 0};      // m/s
  Eigen::Vector2d acceleration{0, 0};  // m/s^2
};

// The place beside a target from which it is followed, at a constant horizontal distance. A free
// one is on the line from the target to the UAV and moves along that line only. Another one moves
// around the target until it is on the side asked for: the UAV never flies across the target.
class StandOff {
 public:
  explicit StandOff(const FollowOptions& options);

  // Begins on the line from the target to the UAV.
  void Start(const Eigen::Vector2d& target, const Eigen::Vector2d& uav);
  // Moves on by 'seconds'.
  void Update(const PlaneMotion& target, const Eigen::Vector2d& uav, double seconds);

  // Returns the motion of the place beside a target with this motion.
  PlaneMotion Beside(const PlaneMotion& target) const;

 private:
  void TurnTo(double direction, double seconds);

  double distance_m_;
  bool is_behind_;
  std::optional<double> bearing_;
  double direction_ = 0;  // from the target to the place, rad from east to north
  double rate_ = 0;       // at which it changes, rad/s; a free one's follows from the motion
};

}  // namespace kestrel
