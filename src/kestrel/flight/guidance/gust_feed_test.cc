// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/gust_feed.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "kestrel/core/poses/gravity.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;

constexpr PathControl kPathControl{.place = 1, .p = 2, .i = 1, .d = 0.25};
constexpr double kFeedStep_s = 0.02;

// A UAV that is to stay where it is, by the control of kPathControl, its thrust a moment late.
struct PushedUav {
  void Step(const Vector2d& push, const GustFeed& feed) {
    constexpr double kLag_s = 0.12;
    path_velocity += kFeedStep_s * feed.acceleration();
    path += kFeedStep_s * path_velocity;
    const Vector2d slip = path_velocity + kPathControl.place * (path - position) - velocity;
    const Vector2d change =
        feed.acceleration() + kPathControl.place * (path_velocity - velocity) - (thrust + push);
    const Vector2d wanted =
        feed.acceleration() + kPathControl.p * slip + integral + kPathControl.d * change;
    integral += kFeedStep_s * kPathControl.i * slip;
    thrust += kFeedStep_s / kLag_s * (wanted - thrust);
    velocity += kFeedStep_s * (thrust + push);
    position += kFeedStep_s * velocity;
  }

  Vector2d position{0, 0}, velocity{0, 0}, thrust{0, 0}, integral{0, 0};
  Vector2d path{0, 0}, path_velocity{0, 0};
};

// Returns the RMS distance from the place in gusts, after the first seconds.
double DistanceInGusts(bool is_fed) {
  constexpr double kSettled_s = 10, kEnd_s = 60;
  GustFeed feed(kPathControl);
  const GustFeed none(kPathControl);
  PushedUav uav;
  const Vector2d wind(1, -0.5);
  uav.integral = uav.thrust = -wind;
  double squares = 0;
  int count = 0;
  for (double time_s = 0; time_s < kEnd_s; time_s += kFeedStep_s) {
    feed.Observe(TimeFromNanoseconds(0) + DurationFromSeconds(time_s), uav.velocity,
                 uav.thrust / kGravity);
    if (time_s > 1) feed.Move(/*ahead_s=*/0.14);
    const Vector2d gust(std::sin(2 * time_s), std::sin(1.3 * time_s));
    uav.Step(wind + gust, is_fed ? feed : none);
    if (time_s < kSettled_s) continue;
    squares += uav.position.squaredNorm();
    ++count;
  }
  return std::sqrt(squares / count);
}

TEST(GustFeedTest, KeepsPlaceInGusts) {
  const double left_alone_m = DistanceInGusts(false);
  EXPECT_GT(left_alone_m, 0.2);
  EXPECT_LT(DistanceInGusts(true), 0.4 * left_alone_m);
}

// On the ground the lean explains no motion, and looks like the push of a gust.
TEST(GustFeedTest, GroundIsNoGust) {
  GustFeed feed(kPathControl);
  for (double time_s = 0; time_s < 3; time_s += kFeedStep_s) {
    feed.Observe(TimeFromNanoseconds(0) + DurationFromSeconds(time_s), {0, 0},
                 {0.1 * std::sin(3 * time_s), 0});
    feed.Move(0.14);
  }
  ASSERT_GT(feed.velocity().norm(), 0.1);
  feed.Forget();
  feed.Move(0.14);
  EXPECT_EQ(feed.velocity().norm() + feed.acceleration().norm(), 0);
}

// The control's integral carries it already.
TEST(GustFeedTest, LeavesSteadyWindAlone) {
  GustFeed feed(kPathControl);
  double most_mps = 0;
  for (double time_s = 0; time_s < 10; time_s += kFeedStep_s) {
    feed.Observe(TimeFromNanoseconds(0) + DurationFromSeconds(time_s), {0, 0}, {0.1, 0});
    if (time_s > 2) feed.Move(0.14);
    most_mps = std::max(most_mps, feed.velocity().norm());
  }
  EXPECT_LT(most_mps, 0.01);
}

TEST(GustFeedTest, BeginsAnewAfterAGap) {
  GustFeed feed(kPathControl);
  const auto observe = [&](double time_s, double speed_mps) {
    feed.Observe(TimeFromNanoseconds(0) + DurationFromSeconds(time_s), {speed_mps, 0}, {0, 0});
    feed.Move(0.14);
  };
  for (int i = 0; i < 50; ++i) observe(kFeedStep_s * i, 0.05 * i);
  EXPECT_GT(feed.velocity().norm(), 0.1);
  observe(5, 0);
  EXPECT_EQ(feed.velocity().norm(), 0);
}

}  // namespace
}  // namespace kestrel
