// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/alignment/positive_solver.h"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"

namespace kestrel {
namespace {

TEST(SolvePositive, SolvesForEverySide) {
  Random random(1);
  constexpr int kSize = 7, kSides = 3;
  for (int trial = 0; trial < 20; ++trial) {
    Eigen::Matrix<double, 9, kSize> rows;
    for (double& value : rows.reshaped()) value = random.Normal();
    // Unknowns of very different units.
    for (int k = 0; k < kSize; ++k) rows.col(k) *= std::pow(10.0, k - 3);
    const Eigen::Matrix<double, kSize, kSize> h = rows.transpose() * rows;
    Eigen::Matrix<double, kSize, kSides> b;
    for (double& value : b.reshaped()) value = random.Normal();
    const Eigen::Matrix<double, kSize, kSides> x = SolvePositive<kSize, kSides>(h, b);
    EXPECT_LT((h * x - b).norm(), 1e-6 * b.norm()) << trial;
    EXPECT_LT((x - h.inverse() * b).norm(), 1e-6 * x.norm()) << trial;
  }
}

TEST(SolvePositive, ReadsLowerTriangleOnly) {
  Eigen::Matrix2d h;
  h << 4, 99, 2, 3;
  const Eigen::Vector2d x = SolvePositive<2, 1>(h, {10, 9});
  EXPECT_NEAR(x.x(), 1.5, 1e-12);
  EXPECT_NEAR(x.y(), 2, 1e-12);
}

}  // namespace
}  // namespace kestrel
