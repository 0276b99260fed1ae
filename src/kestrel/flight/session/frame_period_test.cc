// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/session/frame_period.h"

#include <chrono>

#include <gtest/gtest.h>

namespace kestrel {
namespace {

using std::chrono::milliseconds;

TEST(FramePeriodTest, DroppedFramesDoNotLengthenPeriod) {
  FramePeriod period;
  for (int i = 0; i < 40; ++i) {
    if (i % 3 == 1) continue;
    period.Add(Time(milliseconds(50 * i)));
  }
  EXPECT_EQ(period.Get(), Duration(milliseconds(50)));
}

TEST(FramePeriodTest, LateFramesDoNotShortenPeriod) {
  FramePeriod period;
  for (int i = 0; i < 40; ++i) period.Add(Time(milliseconds(50 * i + (i % 6 == 0 ? 45 : 0))));
  EXPECT_EQ(period.Get(), Duration(milliseconds(50)));
}

TEST(FramePeriodTest, FollowsCamera) {
  FramePeriod period;
  Time time{};
  for (int i = 0; i < 20; ++i) period.Add(time += milliseconds(20));
  for (int i = 0; i < 20; ++i) period.Add(time += milliseconds(100));
  EXPECT_EQ(period.Get(), Duration(milliseconds(100)));
}

TEST(FramePeriodTest, IsUnknownForFewOrIdenticalTimes) {
  FramePeriod period;
  EXPECT_FALSE(period.Get());
  for (int i = 0; i < 100; ++i) period.Add(Time(milliseconds(7)));
  EXPECT_FALSE(period.Get());
}

}  // namespace
}  // namespace kestrel
