// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/take_off_ground.h"

#include <gtest/gtest.h>

namespace kestrel {
namespace {

TEST(TakeOffGroundTest, IsUnderTheFeetUntilTheyLeaveIt) {
  TakeOffGround ground;
  ground.Update(LandedState::kOnGround, 0, -0.3, std::nullopt);
  ground.Update(LandedState::kOnGround, 0, -0.35, std::nullopt);
  ground.Update(LandedState::kInAir, 0, 8, 5);
  EXPECT_EQ(ground.height_m(), -0.35);
}

TEST(TakeOffGroundTest, IsUnderHomeWhenTheProgramStartsInFlight) {
  TakeOffGround ground;
  ground.Update(LandedState::kInAir, 0, 8, std::nullopt);
  EXPECT_EQ(ground.height_m(), std::nullopt);
  ground.Update(LandedState::kInAir, 0, 8, -0.35);
  ground.Update(LandedState::kInAir, 0, 8, 4);  // home is set anew in flight
  EXPECT_EQ(ground.height_m(), -0.35);
}

TEST(TakeOffGroundTest, LandingElsewhereMovesIt) {
  TakeOffGround ground;
  ground.Update(LandedState::kInAir, 0, 8, 0);
  ground.Update(LandedState::kOnGround, 0, 3, 0);
  EXPECT_EQ(ground.height_m(), 3);
}

TEST(TakeOffGroundTest, IsUnderHomeWhereTheFeetAreOfAnotherWorld) {
  TakeOffGround ground;
  ground.Update(LandedState::kOnGround, 0, std::nullopt, 2);
  ground.Update(LandedState::kOnGround, 1, std::nullopt, -0.35);  // a new home after a reboot
  ground.Update(LandedState::kInAir, 1, std::nullopt, 4);
  EXPECT_EQ(ground.height_m(), -0.35);
}

TEST(TakeOffGroundTest, RebootBeginsAnew) {
  TakeOffGround ground;
  ground.Update(LandedState::kOnGround, 0, -0.35, std::nullopt);
  ground.Update(LandedState::kInAir, 1, std::nullopt, std::nullopt);
  EXPECT_EQ(ground.height_m(), std::nullopt);
}

}  // namespace
}  // namespace kestrel
