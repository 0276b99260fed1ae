// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/stale_safety.h"

#include <gtest/gtest.h>

namespace kestrel {
namespace {

using Eigen::Vector3d;

// Way down of an autopilot that flies on for the time-out and then brakes with limited acceleration
// and jerk, by small steps.
double WayDown(double sink_mps, const StaleOptions& options, double link_delay_s) {
  constexpr double kStep_s = 0.001;
  double way_m = sink_mps * (options.timeout_s + link_delay_s);
  double braking = 0;
  for (double speed = sink_mps; speed > 0; speed -= kStep_s * braking) {
    way_m += kStep_s * speed;
    braking = std::min(braking + kStep_s * options.vertical_jerk, options.vertical_braking);
  }
  return way_m;
}

TEST(StaleSafetyTest, DescentByVelocitiesEndsAboveDeck) {
  for (const double timeout_s : {0.1, 0.3, 1.0, 3.0}) {
    const StaleOptions options{.timeout_s = timeout_s};
    for (const double height_m : {0.4, 0.6, 1.0, 2.0, 8.0}) {
      const double sink = StaleSafety(options).MaxSink(height_m, 0.05);
      const double rest_m = height_m - WayDown(sink, options, 0.05);
      EXPECT_GT(rest_m, 0.1) << height_m;
      EXPECT_GT(rest_m, 0.35 * height_m);
      EXPECT_LT(rest_m, 0.55 * height_m) << "not slower than it has to be";
    }
  }
}

TEST(StaleSafetyTest, AllowsNoSinkAtDeck) {
  EXPECT_EQ(StaleSafety({}).MaxSink(0.1, 0), 0);
  EXPECT_EQ(StaleSafety({}).MaxSink(-1, 0), 0);
}

// v = K (place - position), when the set-point arrives.
TEST(StaleSafetyTest, PlacesSetPointByVelocityAndGain) {
  const StaleSafety safety({.position_gain = 0.95, .height_gain = 1.2});
  SetPoint set_point{.velocity = {4, -2, -0.6}};
  const Vector3d position(10, 20, 3);
  const Vector3d velocity(3, -1, -0.5);
  safety.SetPlace(position, velocity, 0.1, &set_point);
  ASSERT_TRUE(set_point.place);
  const Vector3d way = *set_point.place - (position + 0.1 * velocity);
  EXPECT_NEAR((way.cwiseProduct(Vector3d(0.95, 0.95, 1.2)) - set_point.velocity).norm(), 0, 1e-12);
  EXPECT_NEAR(safety.Level(set_point).place->z(), 3 - 0.05, 1e-12);
  EXPECT_EQ(safety.Level(set_point).velocity.z(), 0);
}

TEST(StaleSafetyTest, KeepsVelocitiesWithoutGains) {
  SetPoint set_point{.velocity = {4, 0, -1}};
  StaleSafety({}).SetPlace({1, 2, 3}, {4, 0, 0}, 0, &set_point);
  EXPECT_FALSE(set_point.place);
  EXPECT_EQ(StaleSafety({}).Level(set_point).velocity, Vector3d(4, 0, 0));
}

}  // namespace
}  // namespace kestrel
