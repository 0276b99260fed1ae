// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/pipeline/measurement_noise.h"

#include <numbers>

#include <gtest/gtest.h>

namespace kestrel {
namespace {

TEST(CovarianceInWorld, AddsEachErrorInItsDirection) {
  const MeasurementNoise noise = {0.3, 180 / std::numbers::pi * 0.02, 0.05};
  // Straight ahead of the camera is the world's x.
  const Eigen::Quaterniond world_from_camera(
      Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitY()));
  const Eigen::Matrix3d covariance = CovarianceInWorld(
      Eigen::Vector3d(0.01, 0.04, 0.09).asDiagonal(), {0, 0, 10}, world_from_camera, noise);
  EXPECT_NEAR(covariance(0, 0), 0.09 + 0.25 + 0.09, 1e-9);
  EXPECT_NEAR(covariance(1, 1), 0.04 + 0.04 + 0.09, 1e-9);
  EXPECT_NEAR(covariance(2, 2), 0.01 + 0.04 + 0.09, 1e-9);
  EXPECT_NEAR(covariance(0, 1), 0, 1e-9);
}

TEST(MeasurementNoise, IsChecked) {
  EXPECT_TRUE(MeasurementNoise().Validate().empty());
  EXPECT_EQ((MeasurementNoise{0, -1, 2}).Validate().size(), 3u);
}

}  // namespace
}  // namespace kestrel
