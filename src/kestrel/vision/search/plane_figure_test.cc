// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/search/plane_figure.h"

#include <algorithm>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;

// A rectangle of 3 by 2 about (1, 5), anticlockwise.
const std::vector<Vector2d> kRectangle{{-0.5, 4}, {2.5, 4}, {2.5, 6}, {-0.5, 6}};

TEST(PlaneFigure, HasMomentsOfRectangle) {
  const FigureMoments moments = MomentsOf(kRectangle);
  EXPECT_NEAR(moments.area, 6, 1e-12);
  EXPECT_TRUE(moments.centroid.isApprox(Vector2d(1, 5)));
  EXPECT_TRUE(
      moments.covariance.isApprox(Eigen::Matrix2d(Vector2d(9. / 12, 4. / 12).asDiagonal())));
  std::vector<Vector2d> clockwise(kRectangle.rbegin(), kRectangle.rend());
  EXPECT_NEAR(MomentsOf(clockwise).area, -6, 1e-12);
}

TEST(PlaneFigure, CompactnessIsAffineInvariant) {
  std::vector<Vector2d> circle, slanted;
  for (int i = 0; i < 200; ++i) {
    circle.emplace_back(std::cos(2 * kPi * i / 200), std::sin(2 * kPi * i / 200));
  }
  EXPECT_NEAR(MomentsOf(circle).Compactness(), 1, 1e-3);
  const Eigen::Matrix2d map{{2, 0.7}, {-0.4, 0.5}};
  for (const Vector2d& corner : kRectangle) slanted.push_back(map * corner);
  const double compactness = MomentsOf(kRectangle).Compactness();
  EXPECT_NEAR(MomentsOf(slanted).Compactness(), compactness, 1e-9);
  EXPECT_LT(compactness, 0.97);
}

TEST(PlaneFigure, HasOneOfTwoPosesOfItsAffineMap) {
  const RigidTransform pose{
      Eigen::Quaterniond(Eigen::AngleAxisd(0.6, Eigen::Vector3d(1, 0.4, 0).normalized()) *
                         Eigen::AngleAxisd(2, Eigen::Vector3d::UnitZ())),
      {0, 0, 8}};
  const Eigen::Matrix2d map =
      pose.rotation.toRotationMatrix().topLeftCorner<2, 2>() / pose.translation.z();
  double nearest = kPi;
  for (const double sign : {1.0, -1.0}) {
    const RigidTransform found =
        PoseOfAffineMap(Eigen::Matrix3d::Identity(), map, Vector2d::Zero(), sign);
    EXPECT_NEAR(found.translation.z(), 8, 1e-9);
    nearest = std::min(nearest, found.rotation.angularDistance(pose.rotation));
  }
  EXPECT_NEAR(nearest, 0, 1e-6);
}

}  // namespace
}  // namespace kestrel
