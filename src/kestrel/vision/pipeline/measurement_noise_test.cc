// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/measurement_noise.h"

#include <numbers>

#include <gtest/gtest.h>

#include "kestrel/core/base/options.h"

namespace kestrel {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
const MeasurementNoise kNoise = {.pose_sigma_m = 0.3,
                                 .attitude_sigma_deg = 0.02 * kDegrees,
                                 .pose_bias_m = 0.1,
                                 .attitude_bias_deg = 0.03 * kDegrees,
                                 .scale_bias = 0.05};
// The camera's optical axis is the world's x axis.
const Eigen::Quaterniond kWorldFromCamera(Eigen::AngleAxisd(std::numbers::pi / 2,
                                                            Eigen::Vector3d::UnitY()));

TEST(CovarianceInWorld, AddsEachErrorInItsDirection) {
  const Eigen::Matrix3d covariance = CovarianceInWorld(
      Eigen::Vector3d(0.01, 0.04, 0.09).asDiagonal(), {0, 0, 10}, kWorldFromCamera, kNoise);
  const Eigen::Vector3d expected(0.09 + 0.09, 0.04 + 0.04 + 0.09, 0.01 + 0.04 + 0.09);
  EXPECT_LT((covariance - Eigen::Matrix3d(expected.asDiagonal())).norm(), 1e-9);
}

TEST(SharedCovarianceInWorld, AddsEachErrorInItsDirection) {
  const Eigen::Matrix3d covariance = SharedCovarianceInWorld({0, 0, 10}, kWorldFromCamera, kNoise);
  const Eigen::Vector3d expected(0.25 + 0.01, 0.09 + 0.01, 0.09 + 0.01);
  EXPECT_LT((covariance - Eigen::Matrix3d(expected.asDiagonal())).norm(), 1e-9);
}

TEST(YawVarianceInWorld, IsVarianceAboutVertical) {
  // The world's z is the camera's -x.
  const double variance =
      YawVarianceInWorld(Eigen::Vector3d(0.01, 0.04, 0.09).asDiagonal(), kWorldFromCamera, kNoise);
  EXPECT_NEAR(variance, 0.01 + 0.02 * 0.02, 1e-9);
}

TEST(MeasurementNoise, ReportsInvalidValues) {
  EXPECT_TRUE(ViolationsOf(MeasurementNoise()).empty());
  EXPECT_EQ(ViolationsOf(MeasurementNoise{0, -1, -1, -1, 90, 2}).size(), 6u);
}

}  // namespace
}  // namespace kestrel
