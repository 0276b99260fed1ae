// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/target_pursuit.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace kestrel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Largest product of the position gain and the delay: above it the UAV would swing about the
// target.
constexpr double kMaxGainDelay = 0.35;
// Share of the acceleration within the limits that is used for braking before a place.
constexpr double kBrakingShare = 0.6;
// From this distance, closing in with a gain k changes the acceleration by k^3 times the distance
// per second: if the autopilot lacks that jerk, the UAV swings. Braking sets in within
// kBrakingOnset_s.
constexpr double kJerkReach_m = 2.5;
constexpr double kBrakingOnset_s = 0.4;
constexpr double kMaxLag_mps = 1;
// Memory of velocity and acceleration of a target without springs, at least, and per metre of
// height: from higher up its place is less exact, and a UAV that shakes sees it less exactly still.
constexpr double kAgileMemory_s = 0.25;
constexpr double kAgileMemory_s_per_m = 0.15;
constexpr double kIntegrateWithin_m = 0.5;
constexpr double kMaxIntegral_mps = 0.8;

// Returns 'vector' turned by the target's curve over the next 'ahead_s'.
Vector3d Turned(const TurnState& motion, const Vector3d& vector, double ahead_s) {
  const double angle = (motion.turn_rate() + 0.5 * ahead_s * motion.turn_change()) * ahead_s;
  return Eigen::AngleAxisd(angle, Vector3d::UnitZ()) * vector;
}

}  // namespace

Vector3d AccelerationAhead(const TurnState& motion, double ahead_s) {
  const Vector3d velocity = Turned(motion, motion.velocity(), ahead_s);
  const double turn_rate = motion.turn_rate() + ahead_s * motion.turn_change();
  return turn_rate * Vector3d(-velocity.y(), velocity.x(), 0);
}

Closing ClosingSpeed(double distance_m, double gain, double braking) {
  const double reach = braking / (gain * gain);  // where the straight line touches the parabola
  if (distance_m <= reach) return {gain * distance_m, gain};
  const double speed = std::sqrt(braking * (2 * distance_m - reach));
  return {speed, braking / speed};
}

TargetPursuit::TargetPursuit(const GuidanceOptions& options)
    : options_(options),
      gain_(options.position_gain),
      braking_(std::min(options.braking, kBrakingShare * options.limits.max_acceleration())) {
  if (options.autopilot_jerk == 0) return;
  gain_ = std::min(gain_, std::cbrt(options.autopilot_jerk / kJerkReach_m));
  braking_ = std::min(braking_, kBrakingOnset_s * options.autopilot_jerk);
}

SetPoint TargetPursuit::To(const Vector2d& place, const Motion& uav, FlightModel* model,
                           double max_speed_mps) const {
  SetPoint command;
  const Vector2d slip = -uav.velocity;
  Close(place - uav.position + model->delay_s() * slip, slip, uav.velocity, Gain(*model), &command);
  const double speed = command.velocity.norm();
  if (speed > max_speed_mps) command.velocity *= max_speed_mps / speed;
  model->Command(&command);
  return command;
}

SetPoint TargetPursuit::Above(const TargetEstimate& target, const Motion& uav, FlightModel* model) {
  return Follow(target, nullptr, uav, model);
}

SetPoint TargetPursuit::Beside(const TargetEstimate& target, const StandOff& place,
                               const Motion& uav, FlightModel* model) {
  return Follow(target, &place, uav, model);
}

SetPoint TargetPursuit::Follow(const TargetEstimate& target, const StandOff* place,
                               const Motion& uav, FlightModel* model) {
  const TurnState& motion = target.motion;
  const double delay_s = model->delay_s();
  const Vector3d velocity = Smoothed(target, uav.height_m);
  const Vector3d later = Turned(motion, velocity, delay_s) + delay_s * smoothed_->change;
  const Vector3d change = AccelerationAhead(motion, delay_s) + smoothed_->change;
  PlaneMotion now{motion.position().head<2>(), velocity.head<2>()};
  PlaneMotion ahead{now.position, later.head<2>(), change.head<2>()};
  if (place != nullptr) {
    now = place->Beside(now);
    ahead = place->Beside(ahead);
  }
  const Vector2d offset = now.position - uav.position;
  const Vector2d slip = now.velocity - uav.velocity;
  Integrate(target, offset);
  SetPoint command;
  command.velocity.head<2>() = ahead.velocity + integral_;
  command.acceleration.head<2>() = ahead.acceleration;
  Close(offset + delay_s * slip, slip, uav.velocity, Gain(*model), &command);
  model->Command(&command);
  return command;
}

void TargetPursuit::Reset() {
  smoothed_.reset();
  integrated_.reset();
  integral_.setZero();
}

double TargetPursuit::Gain(const FlightModel& model) const {
  return std::min(gain_, kMaxGainDelay / std::max(model.delay_s(), 0.01));
}

void TargetPursuit::Close(const Vector2d& offset, const Vector2d& slip, const Vector2d& velocity,
                          double gain, SetPoint* command) const {
  const double distance_m = offset.norm();
  const Closing closing = ClosingSpeed(distance_m, gain, braking_);
  if (distance_m > 0) command->velocity.head<2>() += closing.speed / distance_m * offset;
  // A UAV that is still below that velocity has nothing to brake.
  const Vector2d behind = command->velocity.head<2>() - velocity;
  Vector2d change = closing.rate * slip;
  if (const double along = change.dot(behind); along < 0 && behind.norm() > kMaxLag_mps) {
    change -= along / behind.squaredNorm() * behind;
  }
  command->acceleration.head<2>() += change;
}

// A low pass that turns with the target, so that it does not lag in curves.
Vector3d TargetPursuit::Smoothed(const TargetEstimate& target, double height_m) {
  const Vector3d velocity = target.motion.velocity();
  if (!smoothed_) smoothed_ = {target.time, velocity, Vector3d::Zero()};
  auto& [time, in_world, change] = *smoothed_;
  const double seconds = ToSeconds(target.time - time);
  time = target.time;
  in_world += seconds * (AccelerationAhead(target.motion, 0) + change);
  const Vector3d error = velocity - in_world;
  if (!options_.target_is_agile) {
    in_world += (1 - std::exp(-seconds / GuidanceOptions::kSmoothing_s)) * error;
  } else if (seconds > 0) {
    const double memory_s = std::max(kAgileMemory_s, kAgileMemory_s_per_m * height_m);
    const double kept = std::exp(-seconds / memory_s);
    in_world += (1 - kept * kept) * error;
    change += (1 - kept) * (1 - kept) / seconds * error;
  }
  return in_world;
}

void TargetPursuit::Integrate(const TargetEstimate& target, const Vector2d& offset) {
  const double seconds = integrated_ ? ToSeconds(target.time - *integrated_) : 0;
  integrated_ = target.time;
  integral_ = Eigen::Rotation2Dd(target.motion.turn_rate() * seconds) * integral_;
  if (offset.norm() > kIntegrateWithin_m) return;
  integral_ += GuidanceOptions::kIntegralGain * seconds * offset;
  const double length = integral_.norm();
  if (length > kMaxIntegral_mps) integral_ *= kMaxIntegral_mps / length;
}

}  // namespace kestrel
