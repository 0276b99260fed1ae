// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/target_search.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;
using testing::HasSubstr;

constexpr Time kSearchStart = TimeFromNanoseconds(1'000'000'000);
Time AtSecond(double time_s) { return kSearchStart + DurationFromSeconds(time_s); }

using Way = std::function<Vector2d(double time_s)>;
Vector2d VelocityOf(const Way& way, double time_s) {
  return (way(time_s + 0.05) - way(time_s - 0.05)) / 0.1;
}
double TurnRateOf(const Way& way, double time_s) {
  const Vector2d before = VelocityOf(way, time_s - 0.05);
  const Vector2d after = VelocityOf(way, time_s + 0.05);
  const double cross = before.x() * after.y() - before.y() * after.x();
  return cross / before.squaredNorm() / 0.1;
}

RoadMemory Driven(const Way& way, double seconds) {
  RoadMemory road;
  for (double time_s = 0; time_s <= seconds; time_s += 0.05) {
    road.Add(AtSecond(time_s), way(time_s), VelocityOf(way, time_s), TurnRateOf(way, time_s));
  }
  return road;
}

// 15 km/h on a lemniscate of some 25 m, as the paper's car.
Vector2d Eight(double time_s) {
  const double angle = 4.17 / 12 * time_s;
  return {12 * std::sin(angle), 6 * std::sin(2 * angle)};
}
Vector2d Circle(double time_s) {
  const double angle = 4.17 / 8 * time_s;
  return 8 * Vector2d(std::cos(angle), std::sin(angle));
}
Vector2d Straight(double time_s) { return {4.17 * time_s, 0}; }

double WorstError(const RoadMemory& road, const Way& way, double from_s, double ahead_s) {
  double worst_m = 0;
  for (double s = 0; s <= ahead_s; s += 0.5) {
    worst_m =
        std::max(worst_m, (road.Predict(AtSecond(from_s + s))->position - way(from_s + s)).norm());
  }
  return worst_m;
}

TEST(RoadMemoryTest, PredictsPathOfPreviousLap) {
  for (const Way& way : {Way(Eight), Way(Circle)}) {
    const RoadMemory road = Driven(way, 40);
    ASSERT_TRUE(road.Lap_s());
    EXPECT_TRUE(road.Predict(AtSecond(41))->is_by_lap);
    EXPECT_LT(WorstError(road, way, 40, 15), 2.5);
  }
}

TEST(RoadMemoryTest, ContinuesStraightOrInCurveWithoutLap) {
  EXPECT_LT(WorstError(Driven(Straight, 20), Straight, 20, 10), 0.1);
  const RoadMemory curve = Driven(Circle, 4);
  EXPECT_FALSE(curve.Predict(AtSecond(5))->is_by_lap);
  EXPECT_LT(WorstError(curve, Circle, 4, 2), 0.3);
}

TEST(RoadMemoryTest, GrowsUncertainWithTime) {
  const RoadMemory road = Driven(Straight, 20);
  EXPECT_LT(road.Predict(AtSecond(21))->sigma_m, 1.5);
  EXPECT_GT(road.Predict(AtSecond(30))->sigma_m, 10);
  EXPECT_FALSE(RoadMemory().Predict(kSearchStart));
}

TEST(RoadMemoryTest, StandingTargetHasNoLap) {
  const RoadMemory road = Driven([](double) { return Vector2d(3, 4); }, 30);
  EXPECT_FALSE(road.Lap_s());
  EXPECT_LT((road.Predict(AtSecond(60))->position - Vector2d(3, 4)).norm(), 1e-6);
}

struct FlownSearch {
  std::string steps;
  double nearest_m = 1e9;  // to the target, later than five seconds after its loss
};

// Flies to where the search wants it.
FlownSearch Search(const Way& way, double driven_s, double search_s) {
  const RoadMemory road = Driven(way, driven_s);
  TargetSearch search{GuidanceOptions()};
  search.StartAfterLoss(AtSecond(driven_s), road, way(driven_s));
  FlownSearch flown;
  flown.steps = search.step();
  Vector2d uav = way(driven_s);
  for (double s = 0; s < search_s && !search.IsOver(AtSecond(driven_s + s)); s += 0.1) {
    const std::string before = search.step();
    uav = search.Advance(AtSecond(driven_s + s), road, uav, 0.1);
    if (search.step() != before) flown.steps += std::string("; ") + search.step();
    if (s > 5) flown.nearest_m = std::min(flown.nearest_m, (uav - way(driven_s + s)).norm());
  }
  return flown;
}

TEST(TargetSearchTest, FollowsLapThenWaitsOnRoad) {
  const FlownSearch flown = Search(Eight, 40, 40);
  EXPECT_THAT(flown.steps,
              testing::AllOf(HasSubstr("last lap"), HasSubstr("waits for the target on its road")));
  EXPECT_LT(flown.nearest_m, 2);
}

TEST(TargetSearchTest, ContinuesThenSearchesAround) {
  EXPECT_THAT(
      Search(Straight, 20, 40).steps,
      testing::AllOf(HasSubstr("flies on as it drove"), HasSubstr("searches around the place")));
}

// A fast target on a road that is not known yet passes the place where it was lost again.
TEST(TargetSearchTest, WaitsAtPlaceOfLossWithoutLap) {
  constexpr double kDriven_s = 4;
  const RoadMemory road = Driven(Circle, kDriven_s);
  TargetSearch search{GuidanceOptions()};
  search.StartAfterLoss(AtSecond(kDriven_s), road, Circle(kDriven_s));
  Vector2d uav = Circle(kDriven_s);
  double nearest_m = 1e9;
  for (double s = 0; s < 20; s += 0.1) {
    const Vector2d way = search.Advance(AtSecond(kDriven_s + s), road, uav, 0.1) - uav;
    uav += std::min(1.0, 0.7 / std::max(way.norm(), 1e-9)) * way;
    if (s > 10) nearest_m = std::min(nearest_m, (uav - Circle(kDriven_s)).norm());
  }
  EXPECT_LT(nearest_m, 1);
  EXPECT_THAT(search.step(), HasSubstr("waits where the target was lost"));
}

// From low above a small pad the camera sees little: the target is lost before the UAV has caught
// up.
TEST(TargetSearchTest, CatchesUpBeforeItSearchesAround) {
  constexpr double kDriven_s = 2, kUavSpeed_mps = 7, kStep_s = 0.1;
  GuidanceOptions options;
  options.search_altitude_m = 3;
  const RoadMemory road = Driven(Straight, kDriven_s);
  TargetSearch search(options);
  search.StartAfterLoss(AtSecond(kDriven_s), road, Straight(kDriven_s));
  Vector2d uav = Straight(kDriven_s) - Vector2d(9, 0);
  double nearest_m = 1e9;
  for (double time_s = kDriven_s; time_s < kDriven_s + 5; time_s += kStep_s) {
    const Vector2d way = search.Advance(AtSecond(time_s), road, uav, kStep_s) - uav;
    uav += std::min(1.0, kUavSpeed_mps * kStep_s / std::max(way.norm(), 1e-9)) * way;
    nearest_m = std::min(nearest_m, (uav - Straight(time_s)).norm());
  }
  EXPECT_LT(nearest_m, options.search_altitude_m);
}

TEST(TargetSearchTest, EndsAtTimeLimitOnlyAfterLoss) {
  TargetSearch search{GuidanceOptions()};
  search.Start({0, 0});
  EXPECT_FALSE(search.IsOver(AtSecond(1000)));
  search.StartAfterLoss(AtSecond(1000), Driven(Straight, 5), {0, 0});
  EXPECT_FALSE(search.IsOver(AtSecond(1059)));
  EXPECT_TRUE(search.IsOver(AtSecond(1061)));
}

// The pilot learns why the UAV only hovers.
TEST(TargetSearchTest, ReportsWaitingWithoutTargetInSight) {
  GuidanceOptions options;
  const auto step_after = [&](double wait_s) {
    TargetSearch search(options);
    search.Start({0, 0});
    for (double time_s = 0; time_s < wait_s; time_s += 0.05) {
      search.Advance(AtSecond(time_s), {}, {0, 0}, 0.05);
    }
    return std::string(search.step());
  };
  EXPECT_EQ(step_after(options.search_wait_s - 1), "");
  EXPECT_THAT(step_after(options.search_wait_s + 1), HasSubstr("search_radius_m is 0"));
  options.search_radius_m = 20;
  EXPECT_EQ(step_after(options.search_wait_s + 1), "");
}

}  // namespace
}  // namespace kestrel
