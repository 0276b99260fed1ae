// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/pipeline/calibration_monitor.h"

#include <cmath>

#include <gtest/gtest.h>

#include "kestrel/base/random.h"

namespace kestrel {
namespace {

// Views of a camera whose focal length is 'factor' times the calibration's, each with a standard
// deviation of its own; of the outliers nothing is right.
CalibrationMonitor Watch(double factor, int views, std::uint64_t seed, double outliers = 0) {
  CalibrationMonitor monitor;
  Random random(seed);
  for (int i = 0; i < views; ++i) {
    const double sigma = random.Uniform(0.005, 0.08);
    const double seen = std::log(factor) + sigma * random.Normal();
    // As the detector estimates it: with what one expects of any calibration.
    const double expected = CalibrationEvidence().log_focal_sigma;
    const double weight = 1 / (1 + std::pow(sigma / expected, 2));
    CalibrationEvidence evidence;
    evidence.log_focal = random.Chance(outliers) ? random.Uniform(0.1, 0.3) : weight * seen;
    evidence.log_focal_sigma = sigma * std::sqrt(weight);
    monitor.Add(evidence);
  }
  return monitor;
}

TEST(CalibrationMonitor, SaysTheFocalLengthThatTheViewsSay) {
  double squared_error = 0;
  constexpr int kRuns = 40;
  for (int seed = 0; seed < kRuns; ++seed) {
    const CalibrationMonitor monitor = Watch(1.08, 50, seed);
    ASSERT_TRUE(monitor.Contradiction()) << seed;
    const FocalFactor focal = *monitor.Contradiction();
    EXPECT_EQ(focal.detections, 50);
    EXPECT_NEAR(focal.factor, 1.08, 0.02) << seed;
    EXPECT_LT(focal.sigma, 0.01) << seed;
    squared_error += std::pow((focal.factor - 1.08) / focal.sigma, 2) / kRuns;
  }
  EXPECT_GT(squared_error, 0.2);
  EXPECT_LT(squared_error, 1.5);
}

TEST(CalibrationMonitor, IsSilentWhereTheCalibrationIsRight) {
  for (int seed = 0; seed < 200; ++seed) {
    EXPECT_FALSE(Watch(1, 10 + seed, seed).Contradiction()) << seed;
  }
}

TEST(CalibrationMonitor, IsSilentAboutLessThanOneAndAHalfPercent) {
  EXPECT_FALSE(Watch(1.01, 10000, 1).Contradiction());
}

TEST(CalibrationMonitor, TenViewsAreNeeded) {
  EXPECT_FALSE(Watch(1.2, 9, 1).Focal());
  EXPECT_TRUE(Watch(1.2, 10, 1).Contradiction());
}

TEST(CalibrationMonitor, AFifthOfTheViewsMayBeWrong) {
  EXPECT_NEAR(Watch(0.95, 200, 3, 0.2).Contradiction()->factor, 0.95, 0.01);
  EXPECT_FALSE(Watch(1, 200, 3, 0.2).Contradiction());
}

TEST(CalibrationMonitor, ViewsThatSayNothingAreLeftOut) {
  CalibrationMonitor monitor;
  for (int i = 0; i < 20; ++i) {
    monitor.Add(CalibrationEvidence());
    CalibrationEvidence weak;
    weak.log_focal = -0.3;
    weak.log_focal_sigma = 0.2;
    monitor.Add(weak);
  }
  EXPECT_FALSE(monitor.Focal());
}

}  // namespace
}  // namespace kestrel
