// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include <Eigen/Core>

#include "kestrel/core/poses/set_point.h"
#include "kestrel/flight/guidance/other_uav.h"

namespace kestrel {

// Horizontal distance that a UAV on its way keeps from the others of its team (m), and each UAV
// from those to which it gives way; one at work comes no nearer to those that give way to it.
inline constexpr double kApart_m = 5;
inline constexpr double kGiveWay_m = 6.5;
inline constexpr double kAtWork_m = 4;

// The UAV itself, horizontally.
struct OwnMotion {
  Eigen::Vector2d position;  // m, world
  Eigen::Vector2d velocity;  // m/s, as it flies
  bool is_at_work = false;   // does not move off from those that give way to it
};

// Limits the horizontal velocity of a set-point for a UAV on its way to 'destination' (m, world):
// it comes to others no faster than it can stop before the distance, goes around those that are in
// its way, waits for those that are at its destination, and moves off from those that come to it;
// at work only from those that go first.
// No allocation.
void KeepApart(const OwnMotion& own, const Eigen::Vector2d& destination,
               std::span<const OtherUav> others, SetPoint* command);

}  // namespace kestrel
