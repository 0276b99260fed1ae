// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/world_location.h"

#include <random>

#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/core/geometry/test_rotation.h"

namespace kestrel {
namespace {

TEST(LocateByAltitude, FindsSourcePointOfRay) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 1000; ++i) {
    const double target_height_m = 2 * unit(random);
    const Eigen::Vector3d target(5 * unit(random), 5 * unit(random), target_height_m);
    const Eigen::Vector3d axis(unit(random), unit(random), unit(random) + 2);
    const RigidTransform world_from_camera = {
        Rotation(kPi * unit(random), axis),
        {5 * unit(random), 5 * unit(random), target_height_m + 2 + unit(random)}};
    const Eigen::Vector3d ray = 0.3 * (world_from_camera.Inverse() * target);
    const auto found = LocateByAltitude(ray, world_from_camera, target_height_m);
    ASSERT_TRUE(found);
    EXPECT_LT((*found - target).norm(), 1e-9);
  }
}

TEST(LocateByAltitude, StraightDownIsBelowCamera) {
  const RigidTransform world_from_camera = {Rotation(kPi, Eigen::Vector3d::UnitX()), {3, -4, 10}};
  const auto found = LocateByAltitude(Eigen::Vector3d::UnitZ(), world_from_camera, 1.5);
  ASSERT_TRUE(found);
  EXPECT_LT((*found - Eigen::Vector3d(3, -4, 1.5)).norm(), 1e-12);
}

TEST(LocateByAltitude, ReturnsNothingWhenRayMissesPlane) {
  const RigidTransform world_from_camera = {Eigen::Quaterniond::Identity(), {0, 0, 10}};
  EXPECT_FALSE(LocateByAltitude(Eigen::Vector3d::UnitX(), world_from_camera, 0));
  EXPECT_FALSE(LocateByAltitude(Eigen::Vector3d::UnitZ(), world_from_camera, 0));
  EXPECT_FALSE(LocateByAltitude(-Eigen::Vector3d::UnitZ(), world_from_camera, 10));
}

TEST(PatternYaw, IsUniqueUpToSymmetryOfPad) {
  for (const int symmetry : {1, 2, 4}) {
    for (const double share : {-0.45, -0.1, 0.0, 0.2, 0.49}) {
      const double yaw = share * 2 * kPi / symmetry;
      for (int turn = -symmetry; turn <= symmetry; ++turn) {
        const RigidTransform pose = {
            Rotation(yaw + turn * 2 * kPi / symmetry, Eigen::Vector3d::UnitZ()), {1, 2, 3}};
        EXPECT_NEAR(PatternYaw(pose, symmetry), yaw, 1e-9) << symmetry << " " << turn;
      }
    }
  }
}

// Monte Carlo: lines of sight with errors, cut with a ground with an error.
TEST(WorldLocation, GroundCovarianceIsThatOfManySights) {
  constexpr int kSamples = 20000;
  const Eigen::Vector3d camera(1, 2, 20), ground(13, 18, 0);
  const SightErrors errors{0.01, 0.2, 0.1};
  Random random(1);
  const auto normal3 = [&] {
    return Eigen::Vector3d(random.Normal(), random.Normal(), random.Normal());
  };
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (int i = 0; i < kSamples; ++i) {
    const Eigen::Vector3d turn = errors.direction_rad * normal3();
    const Eigen::Vector3d sight = ground - camera;
    const RigidTransform pose{Eigen::Quaterniond::Identity(),
                              camera + errors.position_m * normal3()};
    const auto at =
        LocateByAltitude(sight + turn.cross(sight), pose, errors.ground_m * random.Normal());
    ASSERT_TRUE(at);
    sum += (*at - ground) * (*at - ground).transpose();
  }
  const Eigen::Matrix3d expected = GroundCovariance(ground - camera, errors);
  EXPECT_LT((sum / kSamples - expected).norm(), 0.05 * expected.norm());
}

}  // namespace
}  // namespace kestrel
