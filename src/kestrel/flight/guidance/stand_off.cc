// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/stand_off.h"

#include <algorithm>
#include <cmath>

#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;

// Nearer to the target, or slower, a direction is not known.
constexpr double kLeastDistance_m = 1;
constexpr double kMoving_mps = 0.7;
// Way around the target: time constant, and largest speed and acceleration beside the target's own.
// The direction of somebody who walks is uncertain by 20 degrees: what follows it at once sways.
constexpr double kAround_s = 3;
constexpr double kAround_mps = 3;
constexpr double kAround_mps2 = 1;

Vector2d Along(double direction) { return {std::cos(direction), std::sin(direction)}; }
Vector2d Across(const Vector2d& along) { return {-along.y(), along.x()}; }

}  // namespace

StandOff::StandOff(const FollowOptions& options)
    : distance_m_(options.distance_m),
      is_behind_(options.side == "behind"),
      bearing_(options.Bearing()) {}

void StandOff::Start(const Vector2d& target, const Vector2d& uav) {
  const Vector2d way = uav - target;
  direction_ = std::atan2(way.y(), way.x());
  rate_ = 0;
}

void StandOff::Update(const PlaneMotion& target, const Vector2d& uav, double seconds) {
  if (bearing_) return TurnTo(*bearing_, seconds);
  if (!is_behind_) {
    if ((uav - target.position).norm() > kLeastDistance_m) Start(target.position, uav);
    return;
  }
  const Vector2d back = -target.velocity;
  const bool moves = back.norm() > kMoving_mps;
  TurnTo(moves ? std::atan2(back.y(), back.x()) : direction_, seconds);
}

void StandOff::TurnTo(double direction, double seconds) {
  const double off = std::remainder(direction - direction_, 2 * kPi);
  const double most = kAround_mps / distance_m_;
  const double change = kAround_mps2 / distance_m_ * seconds;
  const double wanted = std::clamp(off / kAround_s, -most, most);
  rate_ = std::clamp(wanted, rate_ - change, rate_ + change);
  direction_ += rate_ * seconds;
}

PlaneMotion StandOff::Beside(const PlaneMotion& target) const {
  const Vector2d along = Along(direction_), across = Across(along);
  const Vector2d position = target.position + distance_m_ * along;
  if (is_behind_ || bearing_) {
    return {position, target.velocity + distance_m_ * rate_ * across,
            target.acceleration - distance_m_ * rate_ * rate_ * along};
  }
  // The line turns as the target moves across it.
  const double speed = target.velocity.dot(along);
  const double turn = -target.velocity.dot(across) / distance_m_;
  const double change = target.acceleration.dot(along) - distance_m_ * turn * turn;
  return {position, speed * along, change * along + speed * turn * across};
}

}  // namespace kestrel
