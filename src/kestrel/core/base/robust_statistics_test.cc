// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/base/robust_statistics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"

namespace kestrel {
namespace {

// The numbers 0 to count - 1 in random order: each one is its own rank.
std::vector<int> Shuffled(int count) {
  Random random(1);
  std::vector<int> values;
  for (int i = 0; i < count; ++i) {
    const int place = random.Integer(0, i);
    values.insert(values.begin() + place, i);
  }
  return values;
}

TEST(RobustStatistics, RankMatchesSortedValues) {
  for (std::size_t rank = 0; rank < 50; ++rank) {
    EXPECT_EQ(RankedInPlace(Shuffled(50), rank), static_cast<int>(rank));
  }
}

TEST(RobustStatistics, MedianOfEvenCountIsUpperMiddleValue) {
  EXPECT_EQ(MedianInPlace(Shuffled(1)), 0);
  EXPECT_EQ(MedianInPlace(Shuffled(50)), 25);
  EXPECT_EQ(MedianInPlace(Shuffled(51)), 25);
}

TEST(RobustStatistics, UsesGivenSpanOnly) {
  std::array<float, 6> values{5, 1, 3, -100, -100, -100};
  EXPECT_EQ(MedianInPlace(std::span(values).first(3)), 3);
  EXPECT_EQ(values[3], -100);
}

TEST(RobustStatistics, QuantileUsesRequestedRank) {
  EXPECT_EQ(QuantileInPlace(Shuffled(10), 0.75, QuantileRank::kNearest), 7);     // 6.75
  EXPECT_EQ(QuantileInPlace(Shuffled(10), 0.75, QuantileRank::kLower), 6);       // 6.75
  EXPECT_EQ(QuantileInPlace(Shuffled(10), 0.75, QuantileRank::kShareBelow), 7);  // 7.5
  for (const QuantileRank rank :
       {QuantileRank::kNearest, QuantileRank::kLower, QuantileRank::kShareBelow}) {
    EXPECT_EQ(QuantileInPlace(Shuffled(10), 0, rank), 0);
    EXPECT_EQ(QuantileInPlace(Shuffled(10), 1, rank), 9);
  }
}

TEST(RobustStatistics, EstimatesNormalSigmaDespiteOutliers) {
  Random random(2);
  std::vector<double> magnitudes;
  for (int i = 0; i < 20000; ++i) magnitudes.push_back(std::abs(3 * random.Normal()));
  EXPECT_NEAR(RobustSigmaInPlace(magnitudes), 3, 0.05);
  for (int i = 0; i < 200; ++i) magnitudes.push_back(1e9);
  EXPECT_NEAR(RobustSigmaInPlace(magnitudes), 3, 0.1);
}

TEST(RobustStatistics, SigmaOfEmptyRangeIsZero) {
  EXPECT_EQ(RobustSigmaInPlace(std::vector<float>()), 0);
}

}  // namespace
}  // namespace kestrel
