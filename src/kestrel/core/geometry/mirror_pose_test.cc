// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/geometry/mirror_pose.h"

#include <gtest/gtest.h>

#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

RigidTransform PoseOf(const Eigen::Vector3d& turn, const Eigen::Vector3d& place) {
  return {RotationBy(turn), place};
}

TEST(MirrorPose, KeepsPositionAndMirrorsTilt) {
  const RigidTransform pose = PoseOf({kPi - 0.3, 0, 0}, {0, 0, 5});
  const RigidTransform mirrored = MirrorPose(pose);
  EXPECT_EQ(mirrored.translation, pose.translation);
  const Eigen::Vector3d normal = pose.rotation * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d expected(-normal.x(), -normal.y(), normal.z());
  EXPECT_TRUE((mirrored.rotation * Eigen::Vector3d::UnitZ()).isApprox(expected, 1e-12));
}

TEST(MirrorPose, MirroringTwiceGivesOriginalPose) {
  const RigidTransform pose = PoseOf({2.8, 0.2, 0.9}, {0.7, -0.4, 3});
  const RigidTransform back = MirrorPose(MirrorPose(pose));
  EXPECT_LT(back.rotation.angularDistance(pose.rotation), 1e-7);
}

TEST(MirrorPose, FrontalPlaneIsItsOwnMirror) {
  const RigidTransform pose = PoseOf({kPi, 0, 0}, {0, 0, 2});
  EXPECT_LT(MirrorPose(pose).rotation.angularDistance(pose.rotation), 1e-7);
}

}  // namespace
}  // namespace kestrel
