// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "kestrel/flight/ros/ros_node.h"
#include "kestrel/io/bags/camera_info.h"
#include "kestrel/io/bags/serialization.h"
#include "kestrel/vision/pipeline/test_pattern.h"

namespace kestrel {

// Keeps the messages that the node publishes.
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

  // Waits for the newest message of a topic and returns it.
  template <class Message>
  Message Newest(ResultTopic topic) {
    return Await<Message>(topic, [](const Message&) { return true; });
  }
  // The same for a message with this stamp.
  template <class Message>
  Message At(ResultTopic topic, Time stamp) {
    return Await<Message>(topic,
                          [&](const Message& message) { return message.header.stamp == stamp; });
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
  template <class Message, class Condition>
  Message Await(ResultTopic topic, const Condition& is_wanted) {
    std::unique_lock lock(mutex_);
    Message found;
    const auto find = [&] {
      for (auto entry = published_.rbegin(); entry != published_.rend(); ++entry) {
        if (entry->first != topic) continue;
        found = ParseMessage<Message>(entry->second, WireFormat::kRos1, "published");
        if (is_wanted(found)) return true;
      }
      return false;
    };
    EXPECT_TRUE(changed_.wait_for(lock, std::chrono::seconds(60), find));
    return found;
  }

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::pair<ResultTopic, std::string>> published_;
  std::vector<std::string> warnings_;
};

class RosNodeTest : public ::testing::Test {
 protected:
  static NodeOptions Options(const std::string& poses) {
    NodeOptions options;
    options.poses = poses;
    return options;
  }
  template <class Message>
  static void TakeMessage(RosNode* node, const Message& message, const std::string& topic) {
    node->Take({topic, std::string(Message::kType), WireFormat::kRos1, {}},
               SerializeMessage(message, WireFormat::kRos1));
  }
  void TakeCameraInfo(RosNode* node) const {
    TakeMessage(node, CameraInfoOf(camera_), "camera_info");
  }
  void TakeImage(RosNode* node, Time stamp, const std::string& frame = "camera") const {
    static const cv::Mat kImage =
        DrawPattern(CameraModel(camera_), LandingPattern(), camera_from_pattern_);
    TakePicture(node, kImage, stamp, frame);
  }
  static void TakePicture(RosNode* node, const cv::Mat& image, Time stamp,
                          const std::string& frame) {
    ImageMessage message;
    message.header = {0, stamp, frame};
    message.width = static_cast<std::uint32_t>(image.cols);
    message.height = static_cast<std::uint32_t>(image.rows);
    message.step = static_cast<std::uint32_t>(image.step);
    message.encoding = image.channels() == 1 ? "mono8" : "bgr8";
    message.data = {reinterpret_cast<const char*>(image.data), image.total() * image.elemSize()};
    TakeMessage(node, message, "image");
  }
  static void TakePose(RosNode* node, Time stamp, double height_m = 3) {
    const PoseStampedMessage pose{{0, stamp, "map"}, {{10, 20, height_m}, {}}};
    TakeMessage(node, pose, "poses");
  }
  static void TakeMount(RosNode* node) {
    TfMessage mount;
    TransformStampedMessage& transform = mount.transforms.emplace_back();
    transform.header.frame_id = "base_link";
    transform.child_frame_id = "camera";
    transform.transform.orientation = {1, 0, 0, 0};
    TakeMessage(node, mount, kStaticTfTopic);
  }

  static constexpr Time kStamp = TimeFromNanoseconds(5'000'000'000);
  const CameraIntrinsics camera_{640, 480, 400, 400, 319.5, 239.5, DistortionModel::kNone, {}};
  // The camera looks straight down from 3 m.
  const RigidTransform camera_from_pattern_{Eigen::Quaterniond(0, 1, 0, 0), {0.2, 0.1, 3}};
  FakeConnection connection_;
};

}  // namespace kestrel
