// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/poses/zoom_history.h"

#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace kestrel {
namespace {

Time AfterStart(double seconds) { return Time(DurationFromSeconds(seconds)); }

// Five reports a second, of a lens that goes from 1 rad to 0.5 rad between 1 and 2 s.
ZoomHistory Zooming() {
  ZoomHistory history(100);
  for (double s = 0; s < 3.1; s += 0.2) {
    const double view_rad = s < 1 ? 1 : s < 2 ? 1 - 0.5 * (s - 1) : 0.5;
    EXPECT_EQ(history.Add({AfterStart(s), view_rad}), PoseStatus::kOk);
  }
  return history;
}

TEST(ZoomHistoryTest, LensAtRestHasReportedView) {
  const ZoomHistory history = Zooming();
  EXPECT_EQ(history.At(AfterStart(0.5)), 1);
  EXPECT_EQ(history.At(AfterStart(2.5)), 0.5);
  EXPECT_EQ(history.At(AfterStart(3.5)), 0.5);
}

TEST(ZoomHistoryTest, LensThatMovesHasNone) {
  const ZoomHistory history = Zooming();
  for (const double s : {1.05, 1.3, 1.5, 1.7, 1.95}) EXPECT_FALSE(history.At(AfterStart(s))) << s;
}

TEST(ZoomHistoryTest, MotionUpToTheNewestReportIsNoRest) {
  ZoomHistory history(10);
  history.Add({AfterStart(0), 1});
  EXPECT_EQ(history.At(AfterStart(0.1)), 1);
  history.Add({AfterStart(0.2), 0.9});
  EXPECT_FALSE(history.At(AfterStart(0.3)));
  history.Add({AfterStart(0.4), 0.9});
  EXPECT_EQ(history.At(AfterStart(0.5)), 0.9);
}

TEST(ZoomHistoryTest, NoReportBeforeOrTooOldOneGivesNone) {
  const ZoomHistory history = Zooming();
  EXPECT_FALSE(history.At(AfterStart(-0.1)));
  EXPECT_FALSE(history.At(AfterStart(6.5)));
}

TEST(ZoomHistoryTest, ReportsBeforeABreakEndThere) {
  ZoomHistory history(10);
  history.Add({AfterStart(0), 1});
  history.Add({AfterStart(0.2), 1});
  history.Break(AfterStart(0.3));
  EXPECT_EQ(history.At(AfterStart(0.25)), 1);
  EXPECT_FALSE(history.At(AfterStart(0.3)));
  history.Add({AfterStart(0.4), 0.5});
  EXPECT_FALSE(history.At(AfterStart(0.35)));
  history.Add({AfterStart(0.6), 0.5});
  EXPECT_EQ(history.At(AfterStart(0.65)), 0.5);
}

TEST(ZoomHistoryTest, BadReportsAreRejected) {
  ZoomHistory history(2);
  EXPECT_EQ(history.Add({AfterStart(1), 1}), PoseStatus::kOk);
  EXPECT_EQ(history.Add({AfterStart(1), 1}), PoseStatus::kOutOfOrder);
  for (const double view : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(history.Add({AfterStart(2), view}), PoseStatus::kInvalid) << view;
  }
}

}  // namespace
}  // namespace kestrel
