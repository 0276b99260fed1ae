// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/tags/square_pose.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"
#include "kestrel/core/base/robust_statistics.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

using Eigen::Vector3d;

SquareCorners CornersAt(const RigidTransform& pose) {
  return {(pose * Vector3d(-0.5, 0.5, 0)).normalized(), (pose * Vector3d(0.5, 0.5, 0)).normalized(),
          (pose * Vector3d(0.5, -0.5, 0)).normalized(),
          (pose * Vector3d(-0.5, -0.5, 0)).normalized()};
}

// A square that shows its face, up to 60 degrees from aside.
RigidTransform RandomPose(double distance, Random* random) {
  const double around = random->Uniform(0, 2 * kPi);
  const double slant = random->Uniform(0.1, 1);
  const double way = random->Uniform(0, 2 * kPi);
  const double x = random->Uniform(-0.5, 0.5) * distance;
  const double y = random->Uniform(-0.5, 0.5) * distance;
  const Vector3d place(x, y, distance);
  const Eigen::Quaterniond facing =
      Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), -place.normalized());
  const Eigen::AngleAxisd turned(around, Vector3d::UnitZ());
  const Eigen::AngleAxisd tilted(slant, Vector3d(std::cos(way), std::sin(way), 0));
  return {facing * tilted * turned, place};
}

TEST(SquarePose, IsExactForExactCorners) {
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    const RigidTransform pose = RandomPose(random.Uniform(1.5, 8), &random);
    const SquareCorners corners = CornersAt(pose);
    const auto homography = HomographyOfSquare(corners);
    ASSERT_TRUE(homography);
    EXPECT_LT((*homography * Vector3d(0.5, 0.5, 1)).normalized().cross(corners[1]).norm(), 1e-9);
    const auto found = PoseOfSquare(corners, *homography);
    ASSERT_TRUE(found) << i;
    EXPECT_LT((found->translation - pose.translation).norm(), 1e-3) << i;
    EXPECT_LT(found->rotation.angularDistance(pose.rotation), 1e-3) << i;
  }
}

// A square of 17 pixels whose corners are off by half a pixel.
TEST(SquarePose, DistanceOfSmallSquareIsUnbiased) {
  Random random(2);
  constexpr double kDistance = 20, kNoise = 0.5 / 17 / kDistance;  // rad
  std::vector<double> off;
  for (int i = 0; i < 200; ++i) {
    const RigidTransform pose = RandomPose(kDistance, &random);
    SquareCorners corners = CornersAt(pose);
    for (Vector3d& corner : corners) {
      const double x = random.Normal();
      const double y = random.Normal();
      const double z = random.Normal();
      corner = (corner + kNoise * Vector3d(x, y, z)).normalized();
    }
    const auto homography = HomographyOfSquare(corners);
    ASSERT_TRUE(homography);
    const auto found = PoseOfSquare(corners, *homography);
    off.push_back(found ? std::abs(found->translation.norm() / pose.translation.norm() - 1) : 1);
  }
  EXPECT_LT(*std::max_element(off.begin(), off.end()), 0.25);
  EXPECT_LT(MedianInPlace(off), 0.03);
}

TEST(SquarePose, RejectsSquareSeenFromBehind) {
  Random random(3);
  SquareCorners corners = CornersAt(RandomPose(3, &random));
  std::swap(corners[1], corners[3]);
  const auto homography = HomographyOfSquare(corners);
  ASSERT_TRUE(homography);
  EXPECT_FALSE(PoseOfSquare(corners, *homography));
}

}  // namespace
}  // namespace kestrel
