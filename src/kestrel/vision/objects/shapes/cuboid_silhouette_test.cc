// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/objects/shapes/cuboid_silhouette.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace kestrel {
namespace {

constexpr double kHalf = 0.02;
constexpr double kShrinking = 1 / (1 + 2 * kHalf);  // scale of a cube's lower face in the image
const Eigen::Vector2d kTopCenter(0.5, -0.3);

std::vector<Eigen::Vector2d> UpperFace(double yaw) {
  std::vector<Eigen::Vector2d> corners;
  for (int i = 0; i < 4; ++i) {
    const double angle = yaw + std::numbers::pi * (0.25 + 0.5 * i);
    corners.push_back(kTopCenter + std::numbers::sqrt2 * kHalf *
                                       Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return corners;
}

std::vector<Eigen::Vector2d> WithLowerFace(std::vector<Eigen::Vector2d> corners) {
  for (int i = 0; i < 4; ++i) corners.push_back(kShrinking * corners[i]);
  return corners;
}

// Largest distance of a corner from the nearest fitted corner, in half sides.
double CornerError(const CuboidFit& fit, double yaw) {
  double largest = 0;
  for (const Eigen::Vector2d& corner : UpperFace(yaw)) {
    double nearest = 1e9;
    for (const Eigen::Vector2d& found : fit.corners) {
      nearest = std::min(nearest, (found - corner).norm());
    }
    largest = std::max(largest, nearest);
  }
  return largest / kHalf;
}

const Eigen::Vector2d kDigit = kTopCenter + kHalf * Eigen::Vector2d(0.1, -0.15);

TEST(FitCuboid, FindsUpperFaceOfOutlineWithSideFaces) {
  for (double yaw = 0; yaw < 1.5; yaw += 0.1) {
    const auto outline = WithLowerFace(UpperFace(yaw));
    const auto fit = FitCuboid({outline, {}, kDigit, 1, kHalf});
    ASSERT_TRUE(fit);
    EXPECT_LT(CornerError(*fit, yaw), 0.08) << yaw;
    EXPECT_LT(fit->residual, 0.1) << yaw;
  }
}

TEST(FitCuboid, FitsWithoutHeight) {
  const auto outline = WithLowerFace(UpperFace(0.4));
  const auto fit = FitCuboid({outline, {}, kDigit, 1, {}});
  ASSERT_TRUE(fit);
  EXPECT_LT(CornerError(*fit, 0.4), 0.15);
}

TEST(FitCuboid, ToleratesColorlessDarkSideFaces) {
  const auto outline = UpperFace(0.7);
  const auto fit = FitCuboid({outline, {}, kDigit, 1, kHalf});
  ASSERT_TRUE(fit);
  EXPECT_LT(CornerError(*fit, 0.7), 0.08);
}

TEST(FitCuboid, ToleratesLowerFaceCutOffByImage) {
  const auto outline = UpperFace(0.7);
  std::vector<Eigen::Vector2d> cut;
  for (const Eigen::Vector2d& corner : outline) cut.push_back(0.5 * (1 + kShrinking) * corner);
  const auto fit = FitCuboid({outline, cut, kDigit, 1, kHalf});
  ASSERT_TRUE(fit);
  EXPECT_LT(CornerError(*fit, 0.7), 0.1);
}

TEST(FitCuboid, OtherShapesLeaveResidual) {
  std::vector<Eigen::Vector2d> line;
  for (int i = -3; i <= 3; ++i) line.emplace_back(kTopCenter + i * Eigen::Vector2d(kHalf, 0));
  const auto fit = FitCuboid({line, {}, kTopCenter, 1, kHalf});
  ASSERT_TRUE(fit);
  EXPECT_GT(fit->residual, 0.3);
}

TEST(FitCuboid, FindsNothingWhenMostOfItIsCutOff) {
  EXPECT_FALSE(FitCuboid({{}, {}, kTopCenter, 1, kHalf}));
  const auto outline = UpperFace(0);
  const auto cut = WithLowerFace(outline);
  EXPECT_FALSE(FitCuboid({{outline.data(), 1}, cut, kDigit, 1, kHalf}));
}

}  // namespace
}  // namespace kestrel
