// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/autopilots/simulated_uav.h"

#include <cmath>
#include <numbers>

#include "kestrel/core/poses/gravity.h"
#include "kestrel/simulation/vehicle/multicopter_motion.h"

namespace kestrel {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

// If the feet are deeper below the board than this, they are beside or under it.
constexpr double kBoardReach_m = 0.3;
// A climb command above this lifts the UAV off.
constexpr double kLiftOff_mps = 0.1;

Quaterniond Level(double heading) { return Quaterniond(AngleAxisd(heading, Vector3d::UnitZ())); }

}  // namespace

SimulatedUav::SimulatedUav(const SimulatedUavOptions& options, const VehicleWorld& world, Time now,
                           const Vector3d& position, const Vector3d& velocity, double heading,
                           Random* random)
    : options_(options),
      world_(world),
      wind_(MakeWind(options.wind, random)),
      multicopter_(options.multicopter, position, heading, velocity),
      heading_(heading),
      pose_{now, {Level(heading), position}, BodyMotion{velocity, Vector3d::Zero()}} {
  if (position.z() > options.leg_m) return;
  pose_.world_from_body.translation.z() = options.leg_m;
  pose_.motion = BodyMotion{};
  StandOn(false);
}

void SimulatedUav::Step(Time now, const FlightCommand& command, bool motors) {
  const double seconds = ToSeconds(now - pose_.time);
  if (!(seconds > 0)) return;
  const RigidTransform before = pose_.world_from_body;
  pose_.time = now;
  if (body_in_support_ && motors && command.set_point.velocity.z() > kLiftOff_mps) {
    heading_ = LevelHeadingOf(before.rotation);
    multicopter_ = Multicopter(options_.multicopter, before.translation, heading_,
                               pose_.motion->velocity_in_world);
    body_in_support_.reset();
  }
  if (body_in_support_) {
    RideAlong(seconds);
  } else {
    Fly(seconds, command, motors);
    ComeDown();
  }
  pose_.motion->rate_in_body =
      RotationVector(before.rotation.conjugate() * pose_.world_from_body.rotation) / seconds;
}

void SimulatedUav::RideAlong(double seconds) {
  const Vector3d before = pose_.world_from_body.translation;
  pose_.world_from_body = Support() * *body_in_support_;
  pose_.motion->velocity_in_world = (pose_.world_from_body.translation - before) / seconds;
}

void SimulatedUav::Fly(double seconds, const FlightCommand& command, bool motors) {
  if (!motors) {
    Vector3d& velocity = pose_.motion->velocity_in_world;
    velocity.z() -= kGravity * seconds;
    pose_.world_from_body.translation += seconds * velocity;
    return;
  }
  const Vector3d wind = wind_(world_.SceneTime(pose_.time));
  const SetPoint& set_point = command.set_point;
  if (command.is_thrust) {
    multicopter_.StepByThrust(set_point.acceleration, set_point.yaw, wind, seconds);
  } else {
    multicopter_.Step(set_point, wind, seconds);
  }
  pose_.world_from_body = multicopter_.world_from_body();
  pose_.motion->velocity_in_world = multicopter_.velocity();
}

// Stands at the place where its feet have reached the board or the ground, and comes upright there.
void SimulatedUav::ComeDown() {
  RigidTransform& body = pose_.world_from_body;
  const Vector3d feet = body * Vector3d(0, 0, -options_.leg_m);
  const Vector3d feet_in_pattern = world_.PatternAt(pose_.time).Inverse() * feet;
  const bool on_board = feet_in_pattern.z() <= 0 && feet_in_pattern.z() > -kBoardReach_m &&
                        world_.IsOnBoard(feet_in_pattern);
  if (!on_board && feet.z() > 0) return;
  const Vector3d support_velocity =
      on_board ? world_.VelocityAt(pose_.time) : Vector3d(Vector3d::Zero());
  const double heading =
      LevelHeadingOf(body.rotation) - LevelHeadingOf(world_.PatternAt(pose_.time).rotation);
  contact_ = Contact{pose_.time, on_board, feet_in_pattern,
                     pose_.motion->velocity_in_world - support_velocity,
                     std::remainder(heading, 2 * std::numbers::pi)};
  body.translation.head<2>() = feet.head<2>();
  StandOn(on_board);
}

void SimulatedUav::StandOn(bool board) {
  on_board_ = board;
  RigidTransform body_in_support = Support().Inverse() * pose_.world_from_body;
  body_in_support.rotation = Level(LevelHeadingOf(body_in_support.rotation));
  body_in_support.translation.z() = options_.leg_m;
  body_in_support_ = body_in_support;
  pose_.world_from_body = Support() * body_in_support;
}

RigidTransform SimulatedUav::Support() const {
  return on_board_ ? world_.PatternAt(pose_.time) : RigidTransform();
}

}  // namespace kestrel
