// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/core/poses/set_point.h"

namespace kestrel {

// Abilities of the simulated multicopter.
struct MulticopterOptions {
  double max_tilt_deg = 40;
  double max_acceleration = 8;
  double max_speed_mps = 16;
  double max_climb_mps = 4;
  double attitude_lag_s = 0.06;
  double drag = 0.25;
  double velocity_gain = 4;
  double max_turn_dps = 60;

  static void Visit(auto& self, auto&& visit) {
    visit("max_tilt_deg", self.max_tilt_deg, Range{1, 80}, "largest tilt");
    visit("max_acceleration", self.max_acceleration, Range{0.1, 50}, "[m/s^2] horizontal, at most");
    visit("max_speed_mps", self.max_speed_mps, Range{0.1, 50}, "largest horizontal speed");
    visit("max_climb_mps", self.max_climb_mps, Range{0.1, 20}, "largest speed up and down");
    visit("attitude_lag_s", self.attitude_lag_s, Range{0.01, 1},
          "time constant of each of two lags in a row between the command and the thrust");
    visit("drag", self.drag, Range{0, 5},
          "[1/s] deceleration by the air, per m/s of speed through it");
    visit("velocity_gain", self.velocity_gain, Range{0.1, 10},
          "[1/s] gain of its velocity control");
    visit("max_turn_dps", self.max_turn_dps, Range{0, 1000}, "largest rate of turn");
  }
};

// A multicopter with its autopilot: a point of mass 1 that is driven by its thrust, gravity and the
// air. The direction of the thrust is the body's z axis. It follows the command after two lags,
// which model attitude control and motors. The autopilot controls the velocity, which it knows
// (from its inertial unit), and compensates the air's drag as it measures it, a moment late.
class Multicopter {
 public:
  // Level at 'position', with the heading 'heading' (rad, from x to y) and 'velocity'; it hovers by
  // default.
  Multicopter(const MulticopterOptions& options, const Eigen::Vector3d& position, double heading,
              const Eigen::Vector3d& velocity = Eigen::Vector3d::Zero());

  // Flies on for 'seconds', a few ms, in the wind (velocity of the air, m/s).
  void Step(const SetPoint& command, const Eigen::Vector3d& wind, double seconds);

  // The same for an autopilot that controls the velocity itself: the rotors give 'acceleration'
  // (world, m/s^2) in addition to the one that carries the weight, whatever the air does.
  void StepByThrust(const Eigen::Vector3d& acceleration, std::optional<double> yaw,
                    const Eigen::Vector3d& wind, double seconds);

  RigidTransform world_from_body() const;
  const Eigen::Vector3d& position() const { return position_; }
  const Eigen::Vector3d& velocity() const { return velocity_; }

 private:
  Eigen::Vector3d WantedThrust(const SetPoint& command) const;
  Eigen::Vector3d WithinTilt(const Eigen::Vector3d& thrust) const;
  void Move(const Eigen::Vector3d& wanted_thrust, const Eigen::Vector3d& wind, double seconds);
  void Turn(std::optional<double> yaw, double seconds);

  MulticopterOptions options_;
  Eigen::Vector3d position_;
  Eigen::Vector3d velocity_;
  Eigen::Vector3d thrust_;   // acceleration by the rotors
  Eigen::Vector3d lagging_;  // the command after the first lag
  Eigen::Vector3d felt_drag_{0, 0, 0};
  double heading_;
};

}  // namespace kestrel
