// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include <Eigen/Geometry>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/base/random.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/core/poses/set_point.h"
#include "kestrel/simulation/autopilot_rules/landing_rules.h"
#include "kestrel/simulation/autopilots/vehicle_world.h"
#include "kestrel/simulation/scene/motion.h"
#include "kestrel/simulation/vehicle/multicopter.h"
#include "kestrel/simulation/vehicle/wind.h"

namespace kestrel {

struct SimulatedUavOptions {
  SimulatedUavOptions() { multicopter.velocity_gain = 6; }

  MulticopterOptions multicopter;
  WindOptions wind;
  double leg_m = 0.35;

  static void Visit(auto& self, auto&& visit) {
    visit.Group("multicopter", self.multicopter);
    visit.Group("wind", self.wind);
    visit("leg_m", self.leg_m, Range{0.05, 2}, "length from the body's origin down to its feet");
  }
};

// Place and velocity at which a UAV came down.
struct Contact {
  Time time;
  bool on_board = false;                       // otherwise on the ground
  Eigen::Vector3d feet_in_pattern{0, 0, 0};    // middle of its feet, m
  Eigen::Vector3d velocity_in_world{0, 0, 0};  // relative to the surface below, m/s
  double heading_in_pattern = 0;               // nose, rad from the pattern's x axis to its y axis
};

// The true UAV: a multicopter in the wind. After it has come down on the ground or on the vehicle's
// board it stands there, and moves with the board.
class SimulatedUav {
 public:
  // In the air at 'position' (ENU, m) with 'velocity', or on the ground below it if that is not
  // higher than its legs. 'heading' of its x axis, rad from east to north. The world must outlive
  // this.
  SimulatedUav(const SimulatedUavOptions& options, const VehicleWorld& world, Time now,
               const Eigen::Vector3d& position, const Eigen::Vector3d& velocity, double heading,
               Random* random);

  // Continues to 'now', a few ms later. Without motors it falls.
  void Step(Time now, const FlightCommand& command, bool motors);

  // The truth: world_from_body, velocity and angular rate, at the time of the last step.
  const PoseSample& pose() const { return pose_; }
  bool is_standing() const { return body_in_support_.has_value(); }
  // The last contact.
  const std::optional<Contact>& contact() const { return contact_; }

 private:
  void StandOn(bool board);
  void RideAlong(double seconds);
  void Fly(double seconds, const FlightCommand& command, bool motors);
  void ComeDown();
  RigidTransform Support() const;

  SimulatedUavOptions options_;
  const VehicleWorld& world_;
  Path wind_;
  Multicopter multicopter_;
  double heading_;
  PoseSample pose_;
  bool on_board_ = false;
  std::optional<RigidTransform> body_in_support_;  // while it stands
  std::optional<Contact> contact_;
};

}  // namespace kestrel
