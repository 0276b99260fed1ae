// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/base/random.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace kestrel {
namespace {

constexpr int kDraws = 100000;

// The C++ standard specifies the 10000th number of the engine with its default seed.
TEST(RandomTest, MatchesStandardEngine) {
  Random random(5489);
  for (int i = 0; i < 9999; ++i) random.Bits();
  EXPECT_EQ(random.Bits(), 9981545732273789042u);
}

TEST(RandomTest, UniformFillsRangeEvenly) {
  Random random(1);
  double sum = 0;
  double square_sum = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double x = random.Uniform(2, 5);
    ASSERT_GE(x, 2);
    ASSERT_LT(x, 5);
    sum += x - 3.5;
    square_sum += (x - 3.5) * (x - 3.5);
  }
  EXPECT_NEAR(sum / kDraws, 0, 0.015);
  EXPECT_NEAR(square_sum / kDraws, 9.0 / 12, 0.01);
}

TEST(RandomTest, IntegerReachesBothEndsEquallyOften) {
  Random random(2);
  std::array<int, 4> counts{};
  for (int i = 0; i < kDraws; ++i) {
    const int n = random.Integer(-1, 2);
    ASSERT_GE(n, -1);
    ASSERT_LE(n, 2);
    ++counts[n + 1];
  }
  for (const int count : counts) EXPECT_NEAR(count, kDraws / 4.0, 700);
}

TEST(RandomTest, NormalHasUnitSpread) {
  Random random(3);
  double sum = 0;
  double square_sum = 0;
  int beyond_two = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double x = random.Normal();
    sum += x;
    square_sum += x * x;
    beyond_two += std::abs(x) > 2;
  }
  EXPECT_NEAR(sum / kDraws, 0, 0.015);
  EXPECT_NEAR(square_sum / kDraws, 1, 0.02);
  EXPECT_NEAR(beyond_two, 0.0455 * kDraws, 300);
}

TEST(RandomTest, ChanceKeepsItsProbability) {
  Random random(4);
  int hits = 0;
  for (int i = 0; i < kDraws; ++i) hits += random.Chance(0.3);
  EXPECT_NEAR(hits, 0.3 * kDraws, 700);
  EXPECT_FALSE(random.Chance(0));
  EXPECT_TRUE(random.Chance(1));
}

}  // namespace
}  // namespace kestrel
