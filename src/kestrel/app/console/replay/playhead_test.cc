// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/replay/playhead.h"

#include <gtest/gtest.h>

namespace kestrel {
namespace {

using namespace std::chrono_literals;

// Two frames 100 ms apart, and one a second later.
Playhead ThreeFrames() { return Playhead({0ms, 100ms, 1100ms}); }

TEST(PlayheadTest, SeeksNearestFrame) {
  Playhead head = ThreeFrames();
  for (const auto& [seconds, frame] :
       {std::pair{-1e300, 0U}, {0.04, 0U}, {0.06, 1U}, {0.59, 1U}, {0.61, 2U}, {1e300, 2U}}) {
    head.Seek(seconds);
    EXPECT_EQ(head.frame(), frame) << seconds;
  }
}

TEST(PlayheadTest, StepsWithinEndsAndHolds) {
  Playhead head = ThreeFrames();
  head.Play(2);
  head.Step(1);
  EXPECT_EQ(head.frame(), 1u);
  EXPECT_EQ(head.speed(), 0);
  head.Step(1e300);
  EXPECT_EQ(head.frame(), 2u);
  head.Step(-1e300);
  EXPECT_EQ(head.frame(), 0u);
}

TEST(PlayheadTest, PlaysByTimeAndHoldsAtEnds) {
  Playhead head = ThreeFrames();
  EXPECT_FALSE(head.Advance(10s)) << "it is held";
  head.Play(0.5);
  EXPECT_FALSE(head.Advance(40ms));
  EXPECT_TRUE(head.Advance(100ms));
  EXPECT_EQ(head.frame(), 1u);
  EXPECT_TRUE(head.Advance(10s));
  EXPECT_EQ(head.frame(), 2u);
  EXPECT_EQ(head.speed(), 0);
  head.Play(1);
  EXPECT_EQ(head.frame(), 0u) << "from the end it begins anew";
  head.Seek(1.1);
  head.Play(-1e9);
  EXPECT_TRUE(head.Advance(100ms));
  EXPECT_EQ(head.frame(), 0u);
  EXPECT_EQ(head.speed(), 0);
}

}  // namespace
}  // namespace kestrel
