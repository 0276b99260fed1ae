// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "kestrel/simulation/autopilots/set_point_reading.h"
#include "kestrel/simulation/autopilots/shaped_path.h"

namespace kestrel {

// Limits within which a mode that holds its place brings the UAV to rest, m/s^2 and m/s^3.
struct StoppingLimits {
  double acceleration;
  double horizontal_jerk;
  double vertical_jerk;
};

// Path to rest of a mode that holds its place. The jerk is bounded: a UAV that sinks sinks on for a
// while.
class StoppingPath {
 public:
  void Start(const FlightState& state) {
    horizontal_.Start(state.position().head<2>(), state.velocity().head<2>());
    vertical_.Start(state.position().tail<1>(), state.velocity().tail<1>());
  }
  void Step(const StoppingLimits& limits, double seconds) {
    horizontal_.Step({0, 0}, {0, 0}, limits.acceleration, limits.horizontal_jerk, seconds);
    vertical_.Step(Vector1d(0), Vector1d(0), limits.acceleration, limits.vertical_jerk, seconds);
  }
  Eigen::Vector3d position() const { return Joined(horizontal_.position(), vertical_.position()); }
  Eigen::Vector3d velocity() const { return Joined(horizontal_.velocity(), vertical_.velocity()); }

 private:
  using Vector1d = ShapedPath<1>::Vector;

  static Eigen::Vector3d Joined(const Eigen::Vector2d& horizontal, const Vector1d& vertical) {
    return {horizontal.x(), horizontal.y(), vertical.x()};
  }

  ShapedPath<2> horizontal_;
  ShapedPath<1> vertical_;
};

}  // namespace kestrel
