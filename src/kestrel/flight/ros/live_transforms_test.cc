// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/ros/live_transforms.h"

#include <gtest/gtest.h>

namespace kestrel {
namespace {

const Time kTransformTime = TimeFromNanoseconds(7'000'000'000);

TransformStampedMessage Shift(const std::string& parent, const std::string& child, double x) {
  return {{0, kTransformTime, parent}, child, {{x, 0, 0}, {}}};
}

TEST(LiveTransforms, FindMountThroughStaticFrames) {
  LiveTransforms transforms;
  transforms.Add(Shift("base_link", "gimbal", 1), /*is_static=*/true);
  transforms.Add(Shift("gimbal", "camera", 2), /*is_static=*/true);
  ASSERT_TRUE(transforms.Fixed("base_link", "camera"));
  EXPECT_EQ(transforms.Fixed("base_link", "camera")->translation.x(), 3);
  EXPECT_EQ(transforms.Fixed("camera", "base_link")->translation.x(), -3);
  transforms.Add(Shift("gimbal", "camera", 2), /*is_static=*/false);
  EXPECT_FALSE(transforms.Fixed("base_link", "camera"));
}

TEST(LiveTransforms, FindPoseOnUpdateOfMovingFrame) {
  LiveTransforms transforms;
  const auto odometry = Shift("odom", "footprint", 5);
  transforms.Add(Shift("footprint", "base_link", 1), /*is_static=*/true);
  transforms.Add(Shift("map", "odom", 10), /*is_static=*/false);
  transforms.Add(odometry, /*is_static=*/false);
  EXPECT_FALSE(transforms.PoseBy(Shift("map", "odom", 10), "base_link"));
  const auto in_root = transforms.PoseBy(odometry, "base_link");
  ASSERT_TRUE(in_root);
  EXPECT_EQ(in_root->world, "map");
  EXPECT_EQ(in_root->sample.time, kTransformTime);
  EXPECT_EQ(in_root->sample.world_from_body.translation.x(), 16);
}

TEST(LiveTransforms, GiveNoPoseForCyclicFrames) {
  LiveTransforms transforms;
  transforms.Add(Shift("a", "b", 1), /*is_static=*/true);
  transforms.Add(Shift("b", "a", 1), /*is_static=*/true);
  EXPECT_FALSE(transforms.Fixed("a", "c"));
  EXPECT_FALSE(transforms.PoseBy(Shift("c", "d", 1), "a"));
}

}  // namespace
}  // namespace kestrel
