// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/ros/landing_node.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/bags/camera_info.h"
#include "kestrel/bags/serialization.h"
#include "kestrel/base/error.h"
#include "kestrel/pipeline/test_pattern.h"

namespace kestrel {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

// Keeps what the node says.
class FakeConnection : public NodeConnection {
 public:
  bool HasSubscribers(ResultTopic) const override { return true; }
  void Publish(ResultTopic topic, const std::string& bytes) override {
    const std::lock_guard lock(mutex_);
    published_.emplace_back(topic, bytes);
    changed_.notify_all();
  }
  void Warn(const std::string& text) override {
    const std::lock_guard lock(mutex_);
    warnings_.push_back(text);
  }
  Time StampNow() const override { return TimeFromNanoseconds(1); }

  // The newest message of a topic, for which it waits.
  template <class Message>
  Message Newest(ResultTopic topic) {
    std::unique_lock lock(mutex_);
    std::string bytes;
    const auto has_one = [&] {
      for (const auto& [of, message] : published_) {
        if (of == topic) bytes = message;
      }
      return !bytes.empty();
    };
    EXPECT_TRUE(changed_.wait_for(lock, std::chrono::seconds(30), has_one));
    return ParseMessage<Message>(bytes, WireFormat::kRos1, "published");
  }
  std::vector<std::string> warnings() const {
    const std::lock_guard lock(mutex_);
    return warnings_;
  }
  bool HasPublished(ResultTopic topic) const {
    const std::lock_guard lock(mutex_);
    return std::any_of(published_.begin(), published_.end(),
                       [&](const auto& message) { return message.first == topic; });
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::pair<ResultTopic, std::string>> published_;
  std::vector<std::string> warnings_;
};

class LandingNodeTest : public ::testing::Test {
 protected:
  static NodeOptions Options(const std::string& poses) {
    return ReadNodeOptions({{"poses", poses}});
  }
  void TakeCameraInfo(LandingNode* node) const {
    node->TakeCameraInfo(SerializeMessage(CameraInfoOf(camera_), WireFormat::kRos1), "camera_info");
  }
  void TakeImage(LandingNode* node, Time stamp, const std::string& frame = "camera") const {
    const cv::Mat image = DrawPattern(CameraModel(camera_), LandingPattern(), camera_from_pattern_);
    ImageMessage message;
    message.header = {0, stamp, frame};
    message.width = static_cast<std::uint32_t>(image.cols);
    message.height = static_cast<std::uint32_t>(image.rows);
    message.step = static_cast<std::uint32_t>(image.step);
    message.encoding = "mono8";
    message.data = {reinterpret_cast<const char*>(image.data), image.total()};
    node->TakeImage(SerializeMessage(message, WireFormat::kRos1), "image");
  }
  static void TakePose(LandingNode* node, Time stamp) {
    const PoseStampedMessage pose{{0, stamp, "map"}, {{10, 20, 3}, {}}};
    node->TakePose(PoseStampedMessage::kType, SerializeMessage(pose, WireFormat::kRos1), "poses");
  }
  static void TakeMount(LandingNode* node) {
    TfMessage mount;
    TransformStampedMessage& transform = mount.transforms.emplace_back();
    transform.header.frame_id = "base_link";
    transform.child_frame_id = "camera";
    transform.transform.orientation = {1, 0, 0, 0};
    node->TakeTransforms(SerializeMessage(mount, WireFormat::kRos1), /*is_static=*/true,
                         "/tf_static");
  }

  static constexpr Time kStamp = TimeFromNanoseconds(5'000'000'000);
  const CameraIntrinsics camera_{640, 480, 400, 400, 319.5, 239.5, DistortionModel::kNone, {}};
  // Looks straight down from 3 m.
  const RigidTransform camera_from_pattern_{Eigen::Quaterniond(0, 1, 0, 0), {0.2, 0.1, 3}};
  FakeConnection connection_;
};

TEST_F(LandingNodeTest, AnImageAndItsCameraInfoAreADetection) {
  LandingNode node(Options("none"), &connection_);
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
  node.PublishDiagnostics();
  const auto status = connection_.Newest<DiagnosticArrayMessage>(ResultTopic::kDiagnostics).status;
  ASSERT_EQ(status.size(), 1);
  EXPECT_EQ(status[0].level, DiagnosticStatusMessage::kOk);
  EXPECT_TRUE(connection_.warnings().empty());
}

TEST_F(LandingNodeTest, WithPosesAndTheMountThereIsATrackInTheWorld) {
  LandingNode node(Options("topic"), &connection_);
  TakeCameraInfo(&node);
  TakeMount(&node);
  for (int i = 0; i < 8; ++i) {
    const Time stamp = kStamp + i * std::chrono::milliseconds(100);
    TakePose(&node, stamp);
    TakePose(&node, stamp + std::chrono::milliseconds(50));
    TakeImage(&node, stamp);
    while (connection_.Newest<Detection3DArrayMessage>(ResultTopic::kDetections).header.stamp !=
           stamp) {
    }
  }
  const auto track = connection_.Newest<OdometryMessage>(ResultTopic::kTrack);
  EXPECT_EQ(track.header.frame_id, "map");
  // The camera's x is the world's, its y and z point the other way.
  EXPECT_NEAR(track.pose.position.x, 10.2, 0.05);
  EXPECT_NEAR(track.pose.position.y, 19.9, 0.05);
  EXPECT_NEAR(track.pose.position.z, 0, 0.1);
}

TEST_F(LandingNodeTest, WhatIsMissingIsSaid) {
  LandingNode node(Options("topic"), &connection_);
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

TEST_F(LandingNodeTest, BrokenMessagesAreLeftOutAndSaid) {
  LandingNode node(Options("topic"), &connection_);
  TakeImage(&node, Time());
  EXPECT_THAT(connection_.warnings(), Contains(HasSubstr("have no stamps")));
  TakeImage(&node, kStamp, /*frame=*/"");
  EXPECT_THAT(connection_.warnings(), Contains(HasSubstr("no frame_id")));
  node.TakeImage("cut", "image");
  EXPECT_THAT(connection_.warnings(), Contains(HasSubstr("image: ")));
  node.TakePose("std_msgs/String", "", "poses");
  EXPECT_THAT(connection_.warnings(), Contains(HasSubstr("is of type std_msgs/String")));
}

TEST_F(LandingNodeTest, AStoppedNodeTakesNoImages) {
  LandingNode node(Options("none"), &connection_);
  TakeCameraInfo(&node);
  node.Stop();
  TakeImage(&node, kStamp);
  node.PublishDiagnostics();
  const auto status = connection_.Newest<DiagnosticArrayMessage>(ResultTopic::kDiagnostics).status;
  EXPECT_EQ(status[0].message, "stopped");
  EXPECT_FALSE(connection_.HasPublished(ResultTopic::kDetections));
  node.Start();
  TakeImage(&node, kStamp);
  EXPECT_EQ(connection_.Newest<Detection3DArrayMessage>(ResultTopic::kDetections).detections.size(),
            1);
}

// A bag that is played again.
TEST_F(LandingNodeTest, StampsThatJumpBackStartAnew) {
  LandingNode node(Options("none"), &connection_);
  TakeCameraInfo(&node);
  TakeImage(&node, kStamp + std::chrono::seconds(3));
  TakeImage(&node, kStamp);
  EXPECT_THAT(connection_.warnings(), Contains(HasSubstr("jump back")));
  while (connection_.Newest<Detection3DArrayMessage>(ResultTopic::kDetections).header.stamp !=
         kStamp) {
  }
}

TEST_F(LandingNodeTest, ResetTakesNewOptionsAndRefusesWhatCannotChange) {
  LandingNode node(Options("none"), &connection_);
  EXPECT_THROW(node.Reset(Options("tf")), InputError);
  TakeCameraInfo(&node);
  node.Reset(ReadNodeOptions({{"landing.detector.min_quality", "1"}}));
  TakeImage(&node, kStamp);
  EXPECT_TRUE(
      connection_.Newest<Detection3DArrayMessage>(ResultTopic::kDetections).detections.empty());
}

TEST(NodeOptions, AreThoseOfTheConfigurationByTheSameNames) {
  const NodeOptions options = ReadNodeOptions({{"landing.detector.min_quality", "0.7"},
                                               {"fly.events.pose_wait_s", "0.1"},
                                               {"altitude_m", "5"}});
  EXPECT_EQ(options.kestrel.landing.detector.min_quality, 0.7);
  EXPECT_EQ(options.kestrel.fly.flight.events.pose_wait_s, 0.1);
  EXPECT_EQ(options.altitude_m, 5);
  EXPECT_THROW(ReadNodeOptions({{"landing.detector.min_qualty", "0.7"}}), InputError);
  EXPECT_THROW(ReadNodeOptions({{"poses", "gps"}}), InputError);
}

}  // namespace
}  // namespace kestrel
