// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/stand_off.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;

// Somebody walks off across the line to the UAV. The direction is measured with errors that stay
// for half a second.
TEST(StandOffTest, PlaceBehindWalkerMovesCalmly) {
  constexpr double kStep_s = 0.05, kWalk_mps = 1, kDistance_m = 12, kSettled_s = 20;
  StandOff place({.distance_m = kDistance_m, .side = "behind"});
  Random random(1);
  PlaneMotion walker;
  place.Start(walker.position, {0, -kDistance_m});
  Vector2d before(0, 0);
  double error = 0, hardest = 0;
  for (int i = 0; i < 800; ++i) {
    if (i % 10 == 0) error = Radians(20) * random.Normal();
    walker.velocity = kWalk_mps * Vector2d(std::cos(error), std::sin(error));
    place.Update(walker, {}, kStep_s);
    walker.velocity = {kWalk_mps, 0};
    walker.position += kStep_s * walker.velocity;
    const PlaneMotion beside = place.Beside(walker);
    const Vector2d own = beside.velocity - walker.velocity;  // around the walker
    hardest = std::max(hardest, (own - before).norm() / kStep_s);
    before = own;
    if (i * kStep_s < kSettled_s) continue;
    const Vector2d way = beside.position - walker.position;
    EXPECT_LT(std::abs(std::remainder(std::atan2(way.y(), way.x()) - kPi, 2 * kPi)), Radians(20));
  }
  EXPECT_LT(hardest, 2) << "m/s^2";
}

}  // namespace
}  // namespace kestrel
