// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/deck_ride.h"

#include <cmath>

#include <gtest/gtest.h>

namespace kestrel {
namespace {

using Eigen::Vector2d;

TEST(DeckRideTest, DeterminesCurve) {
  constexpr double kSpeed_mps = 4.2, kRadius_m = 8, kStep_s = 0.02;
  const auto velocity = [&](double time_s) {
    const double angle = kSpeed_mps / kRadius_m * time_s;
    return Vector2d(kSpeed_mps * Vector2d(std::cos(angle), std::sin(angle)));
  };
  DeckRide ride;
  double time_s = 0;
  for (; time_s < 3; time_s += kStep_s) {
    ride.Observe(Time(DurationFromSeconds(time_s)), velocity(time_s));
  }
  EXPECT_NEAR(ride.acceleration().norm(), kSpeed_mps * kSpeed_mps / kRadius_m, 0.1);
  EXPECT_LT((ride.Velocity(0.15) - velocity(time_s - kStep_s + 0.15)).norm(), 0.1);
  ride.Reset();
  EXPECT_EQ(ride.acceleration().norm(), 0);
}

}  // namespace
}  // namespace kestrel
