// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/mount/target_path.h"

#include <cmath>

#include <gtest/gtest.h>

namespace kestrel {
namespace {

std::vector<Time> Times(int count) {
  std::vector<Time> times;
  for (int i = 0; i < count; ++i) times.push_back(Time(DurationFromSeconds(5 + 0.1 * i)));
  return times;
}

TEST(TargetPath, FitsWeightedMeanToStandingTarget) {
  const TargetPath path(Times(2), Eigen::Vector2d(1, 3), 0);
  Eigen::MatrixX3d positions = Eigen::MatrixX3d::Zero(2, 3);
  positions(1, 0) = 1;  // the mean is 0.9
  const Eigen::MatrixX3d residuals = path.Residuals(positions);
  EXPECT_NEAR(residuals(0, 0), -0.9, 1e-12);
  EXPECT_NEAR(residuals(1, 0), 0.3, 1e-12);
  EXPECT_EQ(path.size(), 1);
}

TEST(TargetPath, FitsSmoothCurveExactlyButNotFastOne) {
  const int count = 100;
  const TargetPath path(Times(count), Eigen::VectorXd::Ones(count), 2);
  Eigen::MatrixX3d positions(count, 3);
  for (int i = 0; i < count; ++i) {
    const double t = 0.1 * i;
    positions.row(i) << 3 * t, t * t * t / 100, 0.1 * std::sin(2 * M_PI * t);
  }
  const Eigen::MatrixX3d residuals = path.Residuals(positions);
  EXPECT_LT(residuals.leftCols<2>().cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_GT(residuals.col(2).norm(), 0.9 * positions.col(2).norm());
}

TEST(TargetPath, BridgesGapsInFlight) {
  std::vector<Time> times = Times(10);
  for (const Time time : Times(10)) times.push_back(time + std::chrono::seconds(60));
  const TargetPath path(times, Eigen::VectorXd::Ones(20), 2);
  EXPECT_TRUE(path.Residuals(Eigen::MatrixX3d::Ones(20, 3)).allFinite());
  EXPECT_LE(path.size(), 8);
}

}  // namespace
}  // namespace kestrel
