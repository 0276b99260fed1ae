// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/objects/location/disc_location.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "kestrel/vision/objects/location/ground_plane.h"

namespace kestrel {
namespace {

constexpr double kRadius_m = 0.1;
const Eigen::Vector3d kCenter(0.8, -0.4, 5);
const Eigen::Vector3d kUp = Eigen::Vector3d(0.2, 0.1, -1).normalized();
const Eigen::Vector3d kAlongRow = Eigen::Vector3d::UnitX();

// Cone of the disc's image after a shear along the rows and a stretch of the columns, as by a
// rolling shutter: rays (x, y, 1) become (x + shear y, stretch y, 1).
Cone Distorted(const Cone& cone, double shear, double stretch) {
  Eigen::Matrix3d undo = Eigen::Matrix3d::Identity();
  undo(0, 1) = -shear / stretch;
  undo(1, 1) = 1 / stretch;
  return {undo.transpose() * cone.matrix * undo};
}

TEST(LocateDisc, IsExactWithKnownAttitude) {
  const Cone cone = ConeOfCircle(kCenter, kUp, kRadius_m);
  EXPECT_LT((LocateDisc(cone, kRadius_m, kAlongRow, kUp) - kCenter).norm(), 1e-6);
}

TEST(LocateDisc, IsApproximateWithoutAttitude) {
  const Cone cone = ConeOfCircle(kCenter, kUp, kRadius_m);
  EXPECT_LT((LocateDisc(cone, kRadius_m, kAlongRow, std::nullopt) - kCenter).norm(), 0.02);
}

TEST(LocateDisc, RollingShutterDoesNotChangeDistance) {
  const Eigen::Vector3d below(0, 0, 5);
  const Eigen::Vector3d up(0, 0, -1);
  const Cone cone = Distorted(ConeOfCircle(below, up, kRadius_m), 0.08, 1.07);
  EXPECT_NEAR(LocateDisc(cone, kRadius_m, kAlongRow, up).norm(), 5, 0.02);
  EXPECT_GT(std::abs(LocateDisc(cone, kRadius_m, kAlongRow, std::nullopt).norm() - 5), 0.03);
}

TEST(LocationCovariance, IsElongatedAlongRay) {
  const Eigen::Vector3d position(0, 3, 4);
  const Eigen::Matrix3d covariance = LocationCovariance(position, 0.001, 0.02);
  const Eigen::Vector3d ray = position.normalized();
  EXPECT_NEAR(ray.dot(covariance * ray), 0.1 * 0.1, 1e-12);
  EXPECT_NEAR(covariance(0, 0), 0.005 * 0.005, 1e-12);
}

TEST(GroundPlane, DistanceUsesNearestPossibleHeight) {
  const GroundPlane ground{Eigen::Vector3d(0, 0, -1), 5.0};
  const Eigen::Vector3d ray = Eigen::Vector3d(0, 0.6, 0.8);
  EXPECT_NEAR(*ground.DistanceNear(ray, 9, 0, 0.1), 5 / 0.8, 1e-12);
  EXPECT_NEAR(*ground.DistanceNear(ray, 1, 0, 0.1), 4.9 / 0.8, 1e-12);
  EXPECT_FALSE(ground.DistanceNear(Eigen::Vector3d(0, 1, 0), 5, 0, 0.1)) << "to the horizon";
  EXPECT_FALSE(GroundPlane{}.DistanceNear(ray, 5, 0, 0.1)) << "not known";
}

TEST(LooksLikeDisc, RejectsOtherSizesAndUprightDiscs) {
  const Eigen::Vector3d ray = kCenter.normalized();
  const auto looks = [&](const Eigen::Vector3d& normal, double radius) {
    return LooksLikeDisc(ConeOfCircle(kCenter, normal, radius), ray, kCenter.norm(), kUp, kRadius_m,
                         0.3, 0.001);
  };
  EXPECT_TRUE(looks(kUp, 0.1));
  EXPECT_TRUE(looks(kUp, 0.12));
  EXPECT_FALSE(looks(kUp, 0.15));
  EXPECT_FALSE(looks(Eigen::Vector3d(1, 0, -0.3).normalized(), 0.1)) << "on a banner";
}

}  // namespace
}  // namespace kestrel
