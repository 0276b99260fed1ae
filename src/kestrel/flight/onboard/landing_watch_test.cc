// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/landing_watch.h"

#include <gtest/gtest.h>

namespace kestrel {
namespace {

TEST(LandingWatchTest, DisarmedAfterFlightHasLanded) {
  LandingWatch watch;
  watch.Observe(false, LandedState::kOnGround, 0);
  watch.Observe(true, LandedState::kOnGround, 0);
  watch.Observe(true, LandedState::kInAir, 5);
  EXPECT_FALSE(watch.has_landed());
  watch.Observe(false, LandedState::kOnGround, 2);
  EXPECT_TRUE(watch.has_landed());
}

TEST(LandingWatchTest, ArmedAndDisarmedOnTheGroundHasNotFlown) {
  LandingWatch watch;
  watch.Observe(true, LandedState::kOnGround, 0);
  watch.Observe(true, LandedState::kUnknown, 0.3);
  watch.Observe(false, LandedState::kOnGround, 0.3);
  EXPECT_FALSE(watch.has_landed());
}

TEST(LandingWatchTest, KnowsTheAirByHeightWhereTheAutopilotDoesNotTell) {
  LandingWatch watch;
  watch.Observe(true, LandedState::kUnknown, 10);  // the program begins in the air
  watch.Observe(true, LandedState::kUnknown, 8.5);
  watch.Observe(false, LandedState::kUnknown, 0);
  EXPECT_TRUE(watch.has_landed());
}

}  // namespace
}  // namespace kestrel
