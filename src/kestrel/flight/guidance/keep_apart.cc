// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/keep_apart.h"

#include <algorithm>
#include <cmath>

namespace kestrel {
namespace {

using Eigen::Vector2d;

constexpr double kGain = 0.5;  // 1/s, speed towards another UAV per metre beyond the distance
// Braking of an autopilot with its usual limits (m/s^2), and how late it begins: the radio, the
// link and the control.
constexpr double kBraking = 1.5;
constexpr double kReaction_s = 1;
constexpr int kRounds = 3;
// Further away from the distance nobody is gone around yet.
constexpr double kAround_m = 6;

// At work it comes no nearer to those that give way to it, but does not move off from them either.
bool StaysAtWork(const OwnMotion& own, const OtherUav& other) {
  return own.is_at_work && !other.goes_first;
}

double DistanceTo(const OwnMotion& own, const OtherUav& other) {
  if (other.goes_first) return kGiveWay_m;
  return own.is_at_work ? kAtWork_m : kApart_m;
}

// Largest speed at which two may come to each other that are so far from the distance; less than 0
// within it.
double SafeSpeed(double free_m) {
  const double reaction_mps = kBraking * kReaction_s;
  const double braked_mps =
      std::sqrt(reaction_mps * reaction_mps + 2 * kBraking * std::max(free_m, 0.0)) - reaction_mps;
  return free_m > 0 ? std::min(kGain * free_m, braked_mps) : kGain * free_m;
}

// The approach of a UAV to another one, by its velocity.
struct Nearing {
  Nearing(const OwnMotion& own, const Vector2d& commanded, const OtherUav& other) {
    const Vector2d way = other.position - own.position;
    const double distance_m = std::max(way.norm(), 1e-3);
    to = way / distance_m;
    free_m = distance_m - DistanceTo(own, other);
    double most_mps = SafeSpeed(free_m) + std::min(other.velocity.dot(to), 0.0);
    if (StaysAtWork(own, other)) most_mps = std::max(most_mps, 0.0);
    // A UAV lags behind its commands: what it flies too fast now is commanded the other way.
    const double lag_mps = std::max(own.velocity.dot(to) - most_mps, 0.0);
    excess_mps = std::max(commanded.dot(to) + lag_mps - most_mps, 0.0);
  }

  Vector2d to;        // unit vector to the other one
  double free_m;      // from here to the distance
  double excess_mps;  // speed beyond the largest that is safe
};

}  // namespace

void KeepApart(const OwnMotion& own, const Vector2d& destination, std::span<const OtherUav> others,
               SetPoint* command) {
  const double wanted_mps = command->velocity.head<2>().norm();
  Vector2d velocity = command->velocity.head<2>();
  for (const OtherUav& other : others) {
    const Nearing nearing(own, velocity, other);
    velocity -= nearing.excess_mps * nearing.to;
    const bool is_at_destination = (destination - other.position).norm() < DistanceTo(own, other);
    if (StaysAtWork(own, other) || is_at_destination || nearing.free_m > kAround_m) continue;
    // To the right, as all do, so that two that meet do not go to the same side.
    velocity +=
        std::min(nearing.excess_mps, wanted_mps) * Vector2d(nearing.to.y(), -nearing.to.x());
  }
  // The way around one, or away from it, may lead to another one.
  for (int round = 0; round < kRounds; ++round) {
    for (const OtherUav& other : others) {
      const Nearing nearing(own, velocity, other);
      velocity -= nearing.excess_mps * nearing.to;
    }
  }
  if (velocity == Vector2d(command->velocity.head<2>())) return;
  command->velocity.head<2>() = velocity;
  command->acceleration.head<2>().setZero();
}

}  // namespace kestrel
