// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/following_demand.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/geometry/angles.h"
#include "kestrel/core/poses/gravity.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr Time kStart = TimeFromNanoseconds(1'000'000'000);

// A target on a circle for 'seconds', 50 times per second.
FollowingDemand OnCircle(DemandWatch* watch, double speed_mps, double radius_m, double seconds,
                         const std::optional<AirEstimate>& air = std::nullopt) {
  const double turn_rate = speed_mps / radius_m;
  FollowingDemand demand;
  for (double time_s = 0; time_s < seconds; time_s += 0.02) {
    const double angle = turn_rate * time_s;
    const Vector3d velocity = speed_mps * Vector3d(std::cos(angle), std::sin(angle), 0);
    const Vector3d acceleration = turn_rate * Vector3d(-velocity.y(), velocity.x(), 0);
    demand = watch->Update(kStart + DurationFromSeconds(time_s), velocity, acceleration, air);
  }
  return demand;
}

TEST(FollowingDemandTest, CurveDemandsLean) {
  DemandWatch watch({.max_speed_mps = 12, .max_tilt_deg = 35});
  const FollowingDemand demand = OnCircle(&watch, 8.33, 5.1, 10);
  const double expected = Degrees(std::atan(8.33 * 8.33 / 5.1 / kGravity));
  EXPECT_NEAR(demand.lean_deg, expected, 2.5);
  EXPECT_TRUE(demand.is_beyond_limits());
  EXPECT_THAT(demand.InWords(), testing::MatchesRegex("5[0-9] degrees of lean, the limit is 35"));
}

TEST(FollowingDemandTest, WindAddsToDemand) {
  const AirEstimate air{.drag = 0.8, .wind = Vector2d(-8, 0)};
  DemandWatch watch({});
  const Vector3d velocity(4.2, 0, 0);
  const FollowingDemand demand = watch.Update(kStart, velocity, Vector3d::Zero(), air);
  EXPECT_NEAR(std::tan(Radians(demand.lean_deg)) * kGravity, 0.8 * 12.2, 0.01);
  EXPECT_TRUE(demand.is_beyond_limits());
  DemandWatch without({});
  EXPECT_FALSE(without.Update(kStart, velocity, Vector3d::Zero(), std::nullopt).is_beyond_limits());
}

TEST(FollowingDemandTest, ReportsTooFastTarget) {
  DemandWatch watch({.max_speed_mps = 10});
  EXPECT_EQ(watch.Update(kStart, {13.9, 0, 0}, Vector3d::Zero(), std::nullopt).InWords(),
            "13.9 m/s, the limit is 10");
}

TEST(FollowingDemandTest, RemembersCurveForAWhile) {
  DemandWatch watch({});
  OnCircle(&watch, 4.2, 5, 5);
  const FollowingDemand soon =
      watch.Update(kStart + DurationFromSeconds(7), {4.2, 0, 0}, Vector3d::Zero(), std::nullopt);
  EXPECT_GT(soon.lean_share(), 0.4);
  const FollowingDemand late =
      watch.Update(kStart + DurationFromSeconds(60), {4.2, 0, 0}, Vector3d::Zero(), std::nullopt);
  EXPECT_LT(late.lean_share(), 0.1);
}

}  // namespace
}  // namespace kestrel
