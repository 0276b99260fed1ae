// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/evaluation/statistics.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"

namespace kestrel {
namespace {

TEST(WilsonInterval, AgreesWithTabulatedValues) {
  EXPECT_NEAR(WilsonInterval(8, 10).low, 0.4902, 1e-4);
  EXPECT_NEAR(WilsonInterval(8, 10).high, 0.9433, 1e-4);
  EXPECT_NEAR(WilsonInterval(0, 100).high, 0.0370, 1e-4);
}

TEST(WilsonInterval, IsNeverCertainAndStaysWithinBounds) {
  EXPECT_LT(WilsonInterval(20, 20).low, 1);
  EXPECT_EQ(WilsonInterval(20, 20).high, 1);
  EXPECT_EQ(WilsonInterval(0, 20).low, 0);
  EXPECT_EQ(WilsonInterval(0, 0).low, 0);
  EXPECT_EQ(WilsonInterval(0, 0).high, 1);
}

TEST(ChiSquareBounds, AgreeWithTabulatedValues) {
  EXPECT_NEAR(ChiSquareBounds(3).low, 0.216, 0.05);
  EXPECT_NEAR(ChiSquareBounds(3).high, 9.348, 0.05);
  EXPECT_NEAR(ChiSquareBounds(100).low, 74.222, 0.05);
  EXPECT_NEAR(ChiSquareBounds(100).high, 129.561, 0.05);
}

TEST(MeanNeesBounds, ConvergeToDimensions) {
  const Interval few = MeanNeesBounds(10, 3);
  const Interval many = MeanNeesBounds(1000, 3);
  EXPECT_LT(few.low, many.low);
  EXPECT_GT(few.high, many.high);
  EXPECT_NEAR(many.low, 3, 0.2);
  EXPECT_NEAR(many.high, 3, 0.2);
}

TEST(IndependentCount, IsSmallerForCorrelatedNeighbours) {
  Random random(1);
  std::vector<double> independent, alike;
  double state = 0;
  for (int i = 0; i < 2000; ++i) {
    independent.push_back(random.Normal());
    state = 0.8 * state + random.Normal();
    alike.push_back(state);
  }
  EXPECT_NEAR(IndependentCount(independent), 2000, 150);
  EXPECT_NEAR(IndependentCount(alike), 2000 * 0.2 / 1.8, 40);
  EXPECT_EQ(IndependentCount(std::vector<double>(5, 1.0)), 5);
  EXPECT_EQ(IndependentCount(std::vector<double>{7}), 1);
}

TEST(Quantile, InterpolatesBetweenNeighbours) {
  EXPECT_EQ(Median({3, 1, 2}), 2);
  EXPECT_EQ(Median({4, 1, 2, 3}), 2.5);
  EXPECT_EQ(Quantile({5, 1}, 0), 1);
  EXPECT_EQ(Quantile({5, 1}, 1), 5);
  EXPECT_NEAR(Quantile({0, 10, 20}, 0.95), 19, 1e-12);
}

TEST(Statistics, AreNanWithoutValues) {
  EXPECT_TRUE(std::isnan(Mean({})));
  EXPECT_TRUE(std::isnan(RootMeanSquare({})));
  EXPECT_TRUE(std::isnan(Median({})));
}

TEST(Statistics, GiveMeanAndRootMeanSquare) {
  const std::vector<double> values = {3, -4};
  EXPECT_EQ(Mean(values), -0.5);
  EXPECT_NEAR(RootMeanSquare(values), std::sqrt(12.5), 1e-12);
}

}  // namespace
}  // namespace kestrel
