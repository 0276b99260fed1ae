// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/ros/ros_node.h"

#include <chrono>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/test_folder.h"
#include "kestrel/flight/ros/test_ros_node.h"

namespace kestrel {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::Field;
using ::testing::HasSubstr;

TEST_F(RosNodeTest, AnImageAndItsCameraInfoAreADetection) {
  RosNode node(Options("none"), &connection_);
  TakeCameraInfo(&node);
  TakeImage(&node, kStamp);
  const auto message =
      connection_.Newest<PoseWithCovarianceStampedMessage>(ResultTopic::kTargetPose);
  EXPECT_EQ(message.header.stamp, kStamp);
  EXPECT_EQ(message.header.frame_id, "camera");
  EXPECT_NEAR(message.pose.position.x, 0.2, 0.02);
  EXPECT_NEAR(message.pose.position.z, 3, 0.05);
  EXPECT_GT(message.covariance[0], 0);
  const auto tf = connection_.Newest<TfMessage>(ResultTopic::kTransforms);
  ASSERT_EQ(tf.transforms.size(), 1);
  EXPECT_EQ(tf.transforms[0].child_frame_id, "landing_pattern");
  EXPECT_EQ(connection_.Newest<ImageMessage>(ResultTopic::kAnnotatedImage).encoding, "bgr8");
  node.Tick();
  const auto status = connection_.Newest<DiagnosticArrayMessage>(ResultTopic::kDiagnostics).status;
  ASSERT_EQ(status.size(), 1);
  EXPECT_EQ(status[0].level, DiagnosticStatusMessage::kOk);
  EXPECT_TRUE(connection_.warnings().empty());
}

TEST_F(RosNodeTest, WithPosesAndTheMountThereIsATrackInTheWorld) {
  RosNode node(Options("topic"), &connection_);
  TakeCameraInfo(&node);
  TakeMount(&node);
  for (int i = 0; i < 8; ++i) {
    const Time stamp = kStamp + i * std::chrono::milliseconds(100);
    TakePose(&node, stamp);
    TakePose(&node, stamp + std::chrono::milliseconds(50));
    TakeImage(&node, stamp);
    connection_.At<Detection3DArrayMessage>(ResultTopic::kDetections, stamp);
  }
  const auto track = connection_.Newest<OdometryMessage>(ResultTopic::kTrack);
  EXPECT_EQ(track.header.frame_id, "map");
  // The camera's x points along the world's, its y and z against the world's.
  EXPECT_NEAR(track.pose.position.x, 10.2, 0.05);
  EXPECT_NEAR(track.pose.position.y, 19.9, 0.05);
  EXPECT_NEAR(track.pose.position.z, 0, 0.1);
}

TEST_F(RosNodeTest, WhatIsMissingIsSaid) {
  RosNode node(Options("topic"), &connection_);
  TakeImage(&node, kStamp);
  EXPECT_THAT(connection_.warnings(), Contains(HasSubstr("no camera_info yet")));
  TakeCameraInfo(&node);
  TakeImage(&node, kStamp + std::chrono::seconds(1));
  EXPECT_THAT(connection_.warnings(), Contains(HasSubstr("from base_link to camera")));
  TakeMount(&node);
  TakeImage(&node, kStamp + std::chrono::seconds(2));
  EXPECT_THAT(connection_.warnings(), Contains(HasSubstr("no poses yet")));
  EXPECT_FALSE(connection_.HasPublished(ResultTopic::kDetections));
}

TEST_F(RosNodeTest, BrokenMessagesAreLeftOutAndSaid) {
  RosNode node(Options("topic"), &connection_);
  TakeImage(&node, Time());
  EXPECT_THAT(connection_.warnings(), Contains(HasSubstr("have no stamps")));
  TakeImage(&node, kStamp, /*frame=*/"");
  EXPECT_THAT(connection_.warnings(), Contains(HasSubstr("no frame_id")));
  node.Take({"image", std::string(ImageMessage::kType), WireFormat::kRos1, {}}, "cut");
  EXPECT_THAT(connection_.warnings(), Contains(HasSubstr("image: ")));
  node.Take({"poses", "std_msgs/String", WireFormat::kRos1, {}}, "");
  EXPECT_THAT(connection_.warnings(), Contains(HasSubstr("is of type std_msgs/String")));
}

TEST_F(RosNodeTest, AStoppedNodeTakesNoImages) {
  RosNode node(Options("none"), &connection_);
  TakeCameraInfo(&node);
  node.Stop();
  TakeImage(&node, kStamp);
  node.Tick();
  const auto status = connection_.Newest<DiagnosticArrayMessage>(ResultTopic::kDiagnostics).status;
  EXPECT_EQ(status[0].message, "stopped");
  EXPECT_FALSE(connection_.HasPublished(ResultTopic::kDetections));
  node.Start();
  TakeImage(&node, kStamp);
  EXPECT_EQ(connection_.Newest<Detection3DArrayMessage>(ResultTopic::kDetections).detections.size(),
            1);
}

// This happens when a bag is played again.
TEST_F(RosNodeTest, StampsThatJumpBackStartAnew) {
  RosNode node(Options("none"), &connection_);
  TakeCameraInfo(&node);
  TakeImage(&node, kStamp + std::chrono::seconds(3));
  TakeImage(&node, kStamp);
  EXPECT_THAT(connection_.warnings(), Contains(HasSubstr("jump back")));
  connection_.At<Detection3DArrayMessage>(ResultTopic::kDetections, kStamp);
}

TEST_F(RosNodeTest, UnusedKeysOfTheCalibrationAndAPlainTargetAreWarnings) {
  const TestFolder folder;
  NodeOptions options = Options("none");
  options.camera = folder.Write("lens.yaml",
                                "resolution: [640, 480]\nintrinsics: [400, 400, 319.5, 239.5]\n"
                                "distortion_model: none\nlens_shift: 3\n");
  options.landing.target.kind = "aruco";
  options.landing.target.aruco.family = "aruco_original";
  options.landing.target.aruco.id = 1023;
  const RosNode node(options, &connection_);
  EXPECT_THAT(connection_.warnings(),
              UnorderedElementsAre(HasSubstr("not used, as not known here: 'lens_shift'"),
                                   HasSubstr("aruco_original id 1023 is as plain as")));
}

TEST_F(RosNodeTest, ResetTakesNewOptionsAndRefusesWhatCannotChange) {
  RosNode node(Options("none"), &connection_);
  EXPECT_THROW(node.Reset(Options("tf")), InputError);
  TakeCameraInfo(&node);
  NodeOptions changed = Options("none");
  changed.landing.detector.min_quality = 1;
  node.Reset(changed);
  TakeImage(&node, kStamp);
  EXPECT_TRUE(
      connection_.Newest<Detection3DArrayMessage>(ResultTopic::kDetections).detections.empty());
}

TEST_F(RosNodeTest, AnUpdateTakesWhatNeedsNoResetAndKeepsTheTrack) {
  RosNode node(Options("topic"), &connection_);
  EXPECT_THROW(node.Update(Options("tf")), InputError);
  TakeCameraInfo(&node);
  TakeMount(&node);
  Time stamp = kStamp;
  const auto process = [&] {
    stamp += std::chrono::milliseconds(100);
    TakePose(&node, stamp);
    TakePose(&node, stamp + std::chrono::milliseconds(50));
    TakeImage(&node, stamp);
    return connection_.At<Detection3DArrayMessage>(ResultTopic::kDetections, stamp)
        .detections.size();
  };
  for (int i = 0; i < 8; ++i) EXPECT_EQ(process(), 1);
  NodeOptions changed = Options("topic");
  changed.landing.detector.min_quality = 1;
  changed.landing.tracker.gate = 20;
  changed.ros.target_frame = "car";
  EXPECT_EQ(node.Update(changed),
            "taken: target_frame, landing.detector.min_quality; not taken without a reset: "
            "landing.tracker.gate");
  EXPECT_EQ(process(), 0);
  const auto track = connection_.At<OdometryMessage>(ResultTopic::kTrack, stamp);
  EXPECT_EQ(track.child_frame_id, "car");
}

TEST_F(RosNodeTest, AStopForgetsNothing) {
  RosNode node(Options("none"), &connection_);
  TakeCameraInfo(&node);
  TakeImage(&node, kStamp);
  connection_.At<Detection3DArrayMessage>(ResultTopic::kDetections, kStamp);
  node.Stop();
  TakeImage(&node, kStamp + std::chrono::seconds(1));
  node.Start();
  TakeImage(&node, kStamp + std::chrono::seconds(2));
  connection_.At<Detection3DArrayMessage>(ResultTopic::kDetections,
                                          kStamp + std::chrono::seconds(2));
  node.Tick();
  const auto status = connection_.Newest<DiagnosticArrayMessage>(ResultTopic::kDiagnostics).status;
  EXPECT_THAT(status[0].values, Contains(AllOf(Field(&KeyValueMessage::key, "images processed"),
                                               Field(&KeyValueMessage::value, "2"))));
}

}  // namespace
}  // namespace kestrel
