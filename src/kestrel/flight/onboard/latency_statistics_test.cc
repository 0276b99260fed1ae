// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/latency_statistics.h"

#include <gtest/gtest.h>

namespace kestrel {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

TEST(LatencyHistogram, IsZeroWithoutSamples) {
  const LatencySummary summary = LatencyHistogram().Summary();
  EXPECT_EQ(summary.count, 0u);
  EXPECT_EQ(summary.p99_s, 0);
}

TEST(LatencyHistogram, EstimatesQuantilesWithinOnePercent) {
  LatencyHistogram histogram;
  for (int i = 1; i <= 1000; ++i) histogram.Add(microseconds(10 * i));
  histogram.AddDropped(3);
  const LatencySummary summary = histogram.Summary();
  EXPECT_EQ(summary.count, 1000u);
  EXPECT_EQ(summary.dropped, 3u);
  EXPECT_NEAR(summary.median_s, 5e-3, 5e-5 + 1e-5);
  EXPECT_NEAR(summary.p99_s, 9.9e-3, 1e-4);
  EXPECT_EQ(summary.max_s, 10e-3);
}

TEST(LatencyHistogram, AcceptsAnyTime) {
  LatencyHistogram histogram;
  histogram.Add(milliseconds(-5));
  histogram.Add(Duration(0));
  EXPECT_EQ(histogram.Summary().max_s, 0);
  histogram.Add(std::chrono::hours(20));
  EXPECT_EQ(histogram.Summary().count, 3u);
  EXPECT_EQ(histogram.Summary().max_s, 72'000);
}

TEST(LatencyStatistics, ListsStepsWithSamples) {
  LatencyStatistics statistics({"capture to detection", "detection to message"});
  statistics.step(0).Add(milliseconds(8));
  statistics.step(0).AddDropped();
  EXPECT_EQ(statistics.InWords(),
            "capture to detection: median 7.95 ms, p99 7.95, max 8.00; 1 of 2 dropped\n");
}

}  // namespace
}  // namespace kestrel
