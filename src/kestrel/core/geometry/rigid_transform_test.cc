// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/geometry/rigid_transform.h"

#include <numbers>

#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"

namespace kestrel {
namespace {

RigidTransform RandomTransform(Random* random) {
  RigidTransform transform;
  transform.rotation =
      Eigen::Quaterniond{random->Normal(), random->Normal(), random->Normal(), random->Normal()}
          .normalized();
  transform.translation = {random->Normal(), random->Normal(), random->Normal()};
  return transform;
}

Eigen::Matrix4d MatrixOf(const RigidTransform& transform) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = transform.rotation.toRotationMatrix();
  matrix.topRightCorner<3, 1>() = transform.translation;
  return matrix;
}

TEST(RigidTransform, IsIdentityByDefault) {
  EXPECT_EQ(MatrixOf(RigidTransform()), Eigen::Matrix4d::Identity());
}

TEST(RigidTransform, AgreesWithHomogeneousMatrices) {
  Random random(1);
  for (int trial = 0; trial < 100; ++trial) {
    const RigidTransform c_from_b = RandomTransform(&random);
    const RigidTransform b_from_a = RandomTransform(&random);
    EXPECT_TRUE(MatrixOf(c_from_b * b_from_a).isApprox(MatrixOf(c_from_b) * MatrixOf(b_from_a)));
    EXPECT_TRUE(MatrixOf(c_from_b.Inverse()).isApprox(MatrixOf(c_from_b).inverse()));
    const Eigen::Vector3d point{random.Normal(), random.Normal(), random.Normal()};
    const Eigen::Vector4d reference = MatrixOf(b_from_a) * point.homogeneous();
    EXPECT_TRUE((b_from_a * point).isApprox(reference.head<3>()));
  }
}

TEST(RigidTransform, RotatesByVectorLengthAboutItsDirection) {
  const Eigen::Vector3d quarter_about_z(0, 0, std::numbers::pi / 2);
  EXPECT_TRUE((RotationBy(quarter_about_z) * Eigen::Vector3d::UnitX())
                  .isApprox(Eigen::Vector3d::UnitY(), 1e-12));
  EXPECT_TRUE(RotationBy(Eigen::Vector3d::Zero()).isApprox(Eigen::Quaterniond::Identity()));
  EXPECT_TRUE(RotationVector(RotationBy(quarter_about_z)).isApprox(quarter_about_z, 1e-12));
}

TEST(RigidTransform, KeepsHeadingWhenLevelled) {
  for (const double yaw : {-3.0, -1.0, 0.0, 0.5, 2.5}) {
    for (const double direction : {0.0, 0.8, 2.0, 4.5}) {
      const Eigen::Vector3d lean(0.6 * std::cos(direction), 0.6 * std::sin(direction), 0);
      const Eigen::Quaterniond rotation =
          RotationBy(lean) * Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ());
      EXPECT_NEAR(LevelHeadingOf(rotation), yaw, 1e-12);
      const Eigen::Quaterniond negated(-rotation.coeffs());
      EXPECT_NEAR(LevelHeadingOf(negated), yaw, 1e-12);
    }
  }
}

TEST(RigidTransform, MovesInTargetFrame) {
  Random random(3);
  for (int trial = 0; trial < 100; ++trial) {
    const RigidTransform pose = RandomTransform(&random);
    const Eigen::Vector3d translation{random.Normal(), random.Normal(), random.Normal()};
    const Eigen::Vector3d turn{random.Normal(), random.Normal(), random.Normal()};
    const Eigen::Vector3d point{random.Normal(), random.Normal(), random.Normal()};
    const Eigen::Vector3d turned = RotationBy(turn) * (pose.rotation * point);
    EXPECT_TRUE(
        (Moved(pose, translation, turn) * point).isApprox(turned + pose.translation + translation));
  }
}

TEST(RigidTransform, StaysRigidOverManyProducts) {
  Random random(2);
  RigidTransform product;
  for (int i = 0; i < 100000; ++i) product = RandomTransform(&random) * product;
  EXPECT_NEAR(product.rotation.norm(), 1, 1e-12);
}

}  // namespace
}  // namespace kestrel
