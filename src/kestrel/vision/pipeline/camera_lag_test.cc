// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/camera_lag.h"

#include <random>

#include <gtest/gtest.h>

namespace kestrel {
namespace {

// Sightings of a camera whose images are stamped 'true_lag_s' late.
CameraLag Learn(double true_lag_s, const Eigen::Vector3d& slip_mps, int sightings) {
  constexpr double kSigma_m = 0.05;
  std::mt19937 random(1);
  std::normal_distribution<double> noise_m(0, kSigma_m);
  CameraLag lag;
  for (int i = 0; i < sightings; ++i) {
    const Eigen::Vector3d noise(noise_m(random), noise_m(random), noise_m(random));
    const Eigen::Vector3d uncertain_m = lag.sigma_s() * slip_mps;
    lag.Add(
        (true_lag_s - lag.seconds()) * slip_mps + noise, slip_mps,
        kSigma_m * kSigma_m * Eigen::Matrix3d::Identity() + uncertain_m * uncertain_m.transpose());
  }
  return lag;
}

TEST(CameraLagTest, IsLearntFromTargetThatMoves) {
  const CameraLag lag = Learn(0.04, {4, 0, 0}, 20);
  EXPECT_NEAR(lag.seconds(), 0.04, 0.01);
  EXPECT_LT(lag.sigma_s(), 0.01);
}

TEST(CameraLagTest, StaysUnknownOverStandingTarget) {
  const CameraLag lag = Learn(0.04, {0, 0, 0}, 20);
  EXPECT_EQ(lag.seconds(), 0);
  EXPECT_EQ(lag.sigma_s(), CameraLag::kPrior_s);
}

TEST(CameraLagTest, LongOneIsNotExplainedAway) {
  EXPECT_LE(Learn(0.3, {4, 0, 0}, 50).seconds(), CameraLag::kLongest_s);
}

}  // namespace
}  // namespace kestrel
