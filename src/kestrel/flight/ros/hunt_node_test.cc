// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/flight/ros/test_ros_node.h"
#include "kestrel/io/recording/test_files.h"
#include "kestrel/vision/objects/test_objects.h"

namespace kestrel {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

// A red disc under a camera that looks straight down from 4 m.
class HuntNodeTest : public RosNodeTest {
 protected:
  static NodeOptions HuntOptions(const std::string& poses, const std::string& output) {
    NodeOptions options = Options(poses);
    options.task = "hunt";
    options.output = output;
    return options;
  }
  static void TakeDisc(RosNode* node, Time stamp) {
    static const cv::Mat kImage = [] {
      ObjectScene scene(/*height_m=*/4, /*tilt=*/0);
      scene.DrawDisc(scene.PointUnder({420, 140}, 0.012), 0.1, kRedPaint);
      return scene.Image();
    }();
    TakePicture(node, kImage, stamp, "camera");
  }
  void SetUp() override { camera_info_ = CameraInfoOf(ObjectCamera().intrinsics()); }
  // Five images, one per second, with the UAV 4 m above the ground.
  Time Hunt(RosNode* node) {
    TakeMessage(node, camera_info_, "camera_info");
    TakeMount(node);
    Time stamp = kStamp;
    for (int i = 0; i < 5; ++i) {
      stamp = kStamp + std::chrono::seconds(i);
      TakePose(node, stamp, /*height_m=*/4);
      TakePose(node, stamp + std::chrono::milliseconds(50), /*height_m=*/4);
      TakeDisc(node, stamp);
      connection_.At<Detection3DArrayMessage>(ResultTopic::kDetections, stamp);
    }
    return stamp;
  }

  CameraInfoMessage camera_info_;
};

TEST_F(HuntNodeTest, ObjectsAreDetectionsAndAMap) {
  RosNode node(HuntOptions("topic", ""), &connection_);
  const Time last = Hunt(&node);
  const auto found = connection_.Newest<Detection3DArrayMessage>(ResultTopic::kDetections);
  EXPECT_EQ(found.header.frame_id, "camera");
  ASSERT_EQ(found.detections.size(), 1);
  EXPECT_NEAR(found.detections[0].results[0].pose.position.z, 3.988, 0.05);
  EXPECT_EQ(connection_.Newest<ImageMessage>(ResultTopic::kAnnotatedImage).encoding, "bgr8");
  EXPECT_FALSE(connection_.Newest<MarkerArrayMessage>(ResultTopic::kMarkers).markers.empty());
  EXPECT_FALSE(connection_.HasPublished(ResultTopic::kMap)) << "once a second only";
  node.Tick();
  const auto map = connection_.Newest<Detection3DArrayMessage>(ResultTopic::kMap);
  EXPECT_EQ(map.header.stamp, last);
  EXPECT_EQ(map.header.frame_id, "map");
  ASSERT_EQ(map.detections.size(), 1);
  // The camera's x points along the world's, its y and z against the world's.
  EXPECT_NEAR(map.detections[0].results[0].pose.position.x, 10 + 100.5 / 500 * 3.988, 0.02);
  EXPECT_NEAR(map.detections[0].results[0].pose.position.y, 20 + 99.5 / 500 * 3.988, 0.02);
  EXPECT_EQ(connection_.Newest<MarkerArrayMessage>(ResultTopic::kMapMarkers).markers.size(), 3);
  EXPECT_TRUE(connection_.warnings().empty());
}

TEST_F(HuntNodeTest, TheMapIsSavedAndReplacedOnlyWhenAllowed) {
  const TestFolder files;
  const std::string folder = files / "map";
  RosNode node(HuntOptions("topic", folder), &connection_);
  EXPECT_THROW(node.SaveMap(), InputError) << "no image yet";
  Hunt(&node);
  EXPECT_THAT(node.SaveMap(), HasSubstr("1 objects in " + folder + "/object_map.csv"));
  EXPECT_THAT(ReadFile(folder + "/object_map.csv"), HasSubstr("\n1,red,"));
  EXPECT_FALSE(std::filesystem::exists(folder + "/object_map.geojson"));
  EXPECT_THROW(node.SaveMap(), InputError) << "it is there";
  NodeOptions options = HuntOptions("topic", folder);
  options.force = true;
  options.origin = "50.1, 14.4";
  EXPECT_EQ(node.Update(options), "taken: force, origin");
  node.SaveMap();
  EXPECT_TRUE(std::filesystem::exists(folder + "/object_map.geojson"));
}

TEST_F(HuntNodeTest, WhatIsMissingForAMapIsSaid) {
  const auto error_of = [](RosNode* node) {
    try {
      return node->SaveMap();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  };
  RosNode node(HuntOptions("none", ""), &connection_);
  TakeMessage(&node, camera_info_, "camera_info");
  TakeDisc(&node, kStamp);
  EXPECT_THAT(error_of(&node), HasSubstr("no map without poses"));
  FakeConnection other;
  RosNode with_poses(HuntOptions("topic", ""), &other);
  TakePose(&with_poses, kStamp);
  TakeMessage(&with_poses, camera_info_, "camera_info");
  TakeMount(&with_poses);
  TakeDisc(&with_poses, kStamp);
  EXPECT_THAT(error_of(&with_poses), HasSubstr("set the parameter output"));
  FakeConnection landing;
  RosNode of_pattern(Options("none"), &landing);
  TakeCameraInfo(&of_pattern);
  TakeImage(&of_pattern, kStamp);
  EXPECT_THAT(error_of(&of_pattern), HasSubstr("_task:=hunt"));
}

TEST_F(HuntNodeTest, GrayImagesHaveNoColours) {
  RosNode node(HuntOptions("none", ""), &connection_);
  TakeCameraInfo(&node);
  TakeImage(&node, kStamp);
  EXPECT_THAT(connection_.warnings(), Contains(HasSubstr("the images are gray (mono8)")));
  EXPECT_FALSE(connection_.HasPublished(ResultTopic::kDetections));
}

TEST_F(HuntNodeTest, AModelThatIsNotThereIsAnErrorAtTheStart) {
  NodeOptions options = HuntOptions("none", "");
  const TestFolder files;
  options.model = files / "objects.yaml";
  EXPECT_THROW(RosNode(options, &connection_), InputError);
}

}  // namespace
}  // namespace kestrel
