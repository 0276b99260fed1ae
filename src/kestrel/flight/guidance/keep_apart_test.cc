// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/keep_apart.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

namespace kestrel {
namespace {

using Eigen::Vector2d;

// Flies to a place among others, with a velocity that lags behind the commands and changes by 2
// m/s^2 at most; returns the least distance from any of them.
double FlyTo(const Vector2d& place, std::vector<OtherUav> others, Vector2d* position,
             double seconds, double speed_mps = 4, double lag_s = 0.2) {
  constexpr double kStep_s = 0.05, kBraking = 2;
  Vector2d velocity(0, 0);
  double nearest_m = 1e9;
  for (double t = 0; t < seconds; t += kStep_s) {
    SetPoint command;
    const Vector2d way = place - *position;
    command.velocity.head<2>() = way * std::min(1.0, speed_mps / std::max(way.norm(), 1e-9));
    KeepApart({*position, velocity}, place, others, &command);
    const Vector2d change = (command.velocity.head<2>() - velocity) / lag_s;
    velocity += kStep_s * std::min(1.0, kBraking / std::max(change.norm(), 1e-9)) * change;
    *position += kStep_s * velocity;
    for (OtherUav& other : others) {
      other.position += kStep_s * other.velocity;
      nearest_m = std::min(nearest_m, (other.position - *position).norm());
    }
  }
  return nearest_m;
}

TEST(KeepApartTest, GoesAroundUavInItsWay) {
  Vector2d position(-20, 0.1);
  EXPECT_GT(FlyTo({20, 0}, {{.position = {0, 0}, .goes_first = true}}, &position, 40), 6);
  EXPECT_LT((position - Vector2d(20, 0)).norm(), 0.5);
}

TEST(KeepApartTest, WaitsForUavAtItsDestination) {
  Vector2d position(-20, 0);
  EXPECT_GT(FlyTo({0, 0}, {{.position = {0, 0}, .goes_first = true}}, &position, 30), 6);
  EXPECT_LT((position - Vector2d(-6.5, 0)).norm(), 0.5);
}

TEST(KeepApartTest, BrakesInTimeAlthoughItLags) {
  Vector2d position(-40, 0);
  const OtherUav at_work{.position = {0, 0}, .goes_first = true};
  EXPECT_GT(FlyTo({0, 0}, {at_work}, &position, 30, 9, 1.2), 5);
}

TEST(KeepApartTest, MovesOffFromUavThatComes) {
  Vector2d position(0, 0);
  const OtherUav coming{.position = {20, 0}, .velocity = {-3, 0}, .goes_first = true};
  EXPECT_GT(FlyTo({0, 0}, {coming}, &position, 12), 5);
}

TEST(KeepApartTest, BrakesInTimeBeforeUavThatComesWithItsObject) {
  Vector2d position(-40, 0);
  const OtherUav coming{.position = {0, 0}, .velocity = {-1.4, 0}, .goes_first = true};
  EXPECT_GT(FlyTo({20, 0}, {coming}, &position, 10, 9, 1), kGiveWay_m);
}

TEST(KeepApartTest, DoesNotMoveOffFromOneToAnother) {
  Vector2d position(0, 0);
  const OtherUav in_its_way{.position = {-3, 6.5}, .velocity = {0.3, -0.6}, .goes_first = true};
  const OtherUav beside{.position = {7.5, 2.5}, .velocity = {-0.5, 0}, .goes_first = true};
  EXPECT_GT(FlyTo({-12, 12}, {beside, in_its_way}, &position, 5), 5);
}

// Speed at which a UAV in the origin, on its way at 3 m/s, is sent to another one before it.
double SpeedTowards(const OtherUav& other, bool is_at_work) {
  SetPoint command;
  command.velocity = {3, 0, 0};
  const std::vector<OtherUav> others = {other};
  KeepApart({{0, 0}, {0, 0}, is_at_work}, {20, 0}, others, &command);
  return command.velocity.x();
}

TEST(KeepApartTest, AtWorkComesNoNearerToUavThatGivesWay) {
  EXPECT_EQ(SpeedTowards({.position = {15, 0}}, true), 3);
  EXPECT_LT(SpeedTowards({.position = {6, 0}}, true), 1.5);
  EXPECT_EQ(SpeedTowards({.position = {4, 0}}, true), 0);
  EXPECT_LT(SpeedTowards({.position = {8, 0}}, false), SpeedTowards({.position = {8, 0}}, true));
}

TEST(KeepApartTest, AtWorkDoesNotMoveOffFromUavThatGivesWay) {
  const OtherUav coming{.position = {3, 0}, .velocity = {-1, 0}};
  EXPECT_EQ(SpeedTowards(coming, true), 0);
  EXPECT_LT(SpeedTowards(coming, false), -1);
}

TEST(KeepApartTest, AtWorkMovesOffFromUavThatGoesFirst) {
  EXPECT_LT(SpeedTowards({.position = {3, 0}, .goes_first = true}, true), -1);
}

TEST(KeepApartTest, LeavesCommandAloneFarFromOthers) {
  SetPoint command;
  command.velocity = {3, 1, -1};
  command.acceleration = {0.5, 0, 0};
  const std::vector<OtherUav> others = {{.position = {40, 0}}, {.position = {-8, 0}}};
  KeepApart({{0, 0}, {3, 1}}, {10, 0}, others, &command);
  EXPECT_EQ(command.velocity, Eigen::Vector3d(3, 1, -1));
  EXPECT_EQ(command.acceleration, Eigen::Vector3d(0.5, 0, 0));
}

}  // namespace
}  // namespace kestrel
