// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/geometry/ellipse.h"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace kestrel {
namespace {

RegionMoments MomentsOf(double area, double xx, double yy, double angle) {
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(angle).toRotationMatrix();
  RegionMoments moments;
  moments.area = area;
  moments.centroid = Eigen::Vector2d(12, -7);
  moments.covariance = turn * Eigen::Vector2d(xx, yy).asDiagonal() * turn.transpose();
  return moments;
}

TEST(EllipseFromMoments, RecoversEllipse) {
  const double a = 9, b = 4;
  for (const double angle : {-1.5, -0.4, 0.0, 0.3, 1.2}) {
    const RegionMoments moments = MomentsOf(std::numbers::pi * a * b, a * a / 4, b * b / 4, angle);
    EXPECT_NEAR(moments.Ellipticity(), 1, 1e-12);
    const Ellipse ellipse = EllipseFromMoments(moments);
    EXPECT_EQ(ellipse.center, moments.centroid);
    EXPECT_NEAR(ellipse.semi_major, a, 1e-9);
    EXPECT_NEAR(ellipse.semi_minor, b, 1e-9);
    EXPECT_NEAR(std::remainder(ellipse.angle - angle, std::numbers::pi), 0, 1e-9);
  }
}

TEST(EllipseFromMoments, EmptyMomentsGivePoint) {
  const Ellipse ellipse = EllipseFromMoments(RegionMoments());
  EXPECT_EQ(ellipse.semi_major, 0);
  EXPECT_EQ(ellipse.semi_minor, 0);
}

TEST(RegionMoments, ParallelogramIsNoEllipse) {
  const double width = 6, height = 2;
  const RegionMoments moments =
      MomentsOf(width * height, width * width / 12, height * height / 12, 0.4);
  EXPECT_NEAR(moments.Ellipticity(), 3 / std::numbers::pi, 1e-12);
}

TEST(Ellipse, PointsLieOnScaledOutline) {
  Ellipse ellipse{Eigen::Vector2d(1, 2), 5, 3, 0.7};
  EXPECT_NEAR(ellipse.major_axis().dot(ellipse.minor_axis()), 0, 1e-15);
  for (double t = 0; t < 6; t += 0.5) {
    const Eigen::Vector2d p = ellipse.At(t, 2) - ellipse.center;
    EXPECT_NEAR(std::pow(p.dot(ellipse.major_axis()) / 10, 2) +
                    std::pow(p.dot(ellipse.minor_axis()) / 6, 2),
                1, 1e-12);
  }
  const Eigen::Vector2d doubled = ellipse.At(0.3, 2);
  ellipse.Scale(2);
  EXPECT_LT((ellipse.At(0.3) - doubled).norm(), 1e-12);
}

}  // namespace
}  // namespace kestrel
