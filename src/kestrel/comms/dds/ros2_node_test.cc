// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/dds/ros2_node.h"

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/comms/dds/test_dds.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/base/test_eventually.h"
#include "kestrel/io/ros_messages/result_messages.h"
#include "kestrel/io/ros_messages/serialization.h"
#include "kestrel/io/ros_messages/tag_messages.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

constexpr Duration kLong = std::chrono::seconds(10);
constexpr Duration kShort = std::chrono::milliseconds(300);
constexpr Duration kTick = std::chrono::milliseconds(10);

template <class Message>
std::string BytesOf(const Message& message) {
  return SerializeMessage(message, WireFormat::kCdr);
}

// Returns one message of each published type, with an entry in each of its lists.
std::vector<std::pair<std::string_view, std::string>> SomeMessages() {
  const HeaderMessage header{0, TimeFromNanoseconds(1'700'000'000'123'456'789), "camera"};
  const PoseMessage pose{{1, 2, 3}, {0, 0.6, 0, 0.8}};
  PoseWithCovarianceStampedMessage target{header, {pose, {}}};
  target.pose.covariance[7] = 0.25;
  OdometryMessage odometry{header, "target", {pose, {}}, {{{4, 5, 6}, {7, 8, 9}}, {}}};
  odometry.twist.covariance[35] = 1e-3;
  Detection3DArrayMessage detections;
  detections.header = header;
  Detection3DMessage& detection = detections.detections.emplace_back();
  detection.id = "17";
  detection.results.push_back({{"red", 0.9}, {pose, {}}});
  MarkerArrayMessage markers;
  MarkerMessage& marker = markers.markers.emplace_back();
  marker.points = {{1, 2, 3}, {4, 5, 6}};
  marker.colors = {{1, 0, 0, 1}, {0, 1, 0, 1}};
  marker.text = "odd";
  DiagnosticArrayMessage diagnostics;
  diagnostics.status.push_back({DiagnosticStatusMessage::kWarn, "a", "b", "", {{"k", "v"}}});
  const ImageMessage image{header, 2, 3, "mono8", 0, 3, "abcdef"};
  const CompressedImageMessage compressed{header, "png", "abc"};
  const PoseStampedMessage stamped{header, pose};
  const PathMessage path{header, {stamped, stamped}};
  TfMessage transforms;
  transforms.transforms.push_back({header, "pattern", {{1, 2, 3}, pose.orientation}});
  CameraInfoMessage info;
  info.distortion_model = "plumb_bob";
  info.d = {1, 2, 3, 4, 5};
  TagArrayMessage tags;
  TagMessage& tag = tags.detections.emplace_back();
  tag.family = "tag36h11";
  tag.id = 7;
  tag.decision_margin = 99;
  tag.corners[3] = {12.5, 13.5};
  tag.homography[8] = 1;
  return {{target.kType, BytesOf(target)},
          {odometry.kType, BytesOf(odometry)},
          {detections.kType, BytesOf(detections)},
          {markers.kType, BytesOf(markers)},
          {diagnostics.kType, BytesOf(diagnostics)},
          {image.kType, BytesOf(image)},
          {info.kType, BytesOf(info)},
          {TfMessage::kType, BytesOf(transforms)},
          {PathMessage::kType, BytesOf(path)},
          {CompressedImageMessage::kType, BytesOf(compressed)},
          {TagArrayMessage::kType, BytesOf(tags)}};
}

// Returns the first message that comes within 'timeout'.
std::optional<std::string> Hear(Ros2Node* node, Duration timeout) {
  std::optional<std::string> heard;
  for (const Time end = Now() + timeout; !heard && Now() < end;) {
    node->Take(kTick, [&](std::size_t, std::string_view bytes) { heard = std::string(bytes); });
  }
  return heard;
}

bool FindsSubscriber(const Ros2Node& node, std::size_t publisher, Duration timeout) {
  return Eventually([&] { return node.HasSubscribers(publisher); }, timeout);
}

class Ros2NodeTest : public ::testing::Test {
 protected:
  int domain_ = TestDomain();
};

TEST_F(Ros2NodeTest, DeliversEveryMessageByteForByte) {
  Ros2Node sender(domain_, {"sender"});
  Ros2Node receiver(domain_, {"receiver"});
  for (const auto& [type, bytes] : SomeMessages()) {
    const std::string topic = "/" + std::string(type);
    const std::size_t publisher = sender.Advertise(topic, type, kDefaultQos);
    receiver.Subscribe(topic, type, kDefaultQos);
    ASSERT_TRUE(FindsSubscriber(sender, publisher, kLong)) << type;
    ASSERT_TRUE(sender.Publish(publisher, bytes)) << type;
    EXPECT_EQ(Hear(&receiver, kLong), bytes) << type;
  }
}

TEST_F(Ros2NodeTest, DoesNotPublishBytesOfAnotherType) {
  Ros2Node node(domain_, {});
  const std::size_t image = node.Advertise("/image", ImageMessage::kType, kSensorDataQos);
  ImageMessage message;
  message.encoding = "mono8";
  message.data = "abcdef";
  const std::string bytes = BytesOf(message);
  EXPECT_TRUE(node.Publish(image, bytes));
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(node.Publish(image, bytes.substr(0, size))) << size;
  }
  EXPECT_FALSE(node.Publish(image, bytes + "more than an image"));
  EXPECT_THROW(node.Advertise("/a", "std_msgs/String", kDefaultQos), InputError);
  EXPECT_THROW(node.Advertise("/not a name", ImageMessage::kType, kDefaultQos), InputError);
}

// As docs.ros.org has it: a publisher must offer what a subscriber requests.
TEST_F(Ros2NodeTest, MatchesQosLikeRos) {
  struct Case {
    Ros2Qos offered, requested;
    bool do_match;
  };
  const Ros2Qos reliable{true, false, 10}, best_effort{false, false, 1}, kept{true, true, 1},
      best_effort_kept{false, true, 5};
  const std::vector<Case> cases = {{reliable, reliable, true},
                                   {reliable, best_effort, true},
                                   {reliable, kept, false},
                                   {reliable, best_effort_kept, false},
                                   {best_effort, reliable, false},
                                   {best_effort, best_effort, true},
                                   {best_effort, kept, false},
                                   {best_effort, best_effort_kept, false},
                                   {kept, reliable, true},
                                   {kept, best_effort, true},
                                   {kept, kept, true},
                                   {kept, best_effort_kept, true},
                                   {best_effort_kept, reliable, false},
                                   {best_effort_kept, best_effort, true},
                                   {best_effort_kept, kept, false},
                                   {best_effort_kept, best_effort_kept, true}};
  Ros2Node sender(domain_, {});
  Ros2Node receiver(domain_, {});
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const std::string topic = "/qos" + std::to_string(i);
    sender.Advertise(topic, TfMessage::kType, cases[i].offered);
    receiver.Subscribe(topic, TfMessage::kType, cases[i].requested);
  }
  // Endpoints are announced in their order.
  const std::size_t last = sender.Advertise("/last", TfMessage::kType, kDefaultQos);
  receiver.Subscribe("/last", TfMessage::kType, kDefaultQos);
  ASSERT_TRUE(FindsSubscriber(sender, last, kLong));
  for (std::size_t i = 0; i < cases.size(); ++i) {
    EXPECT_EQ(FindsSubscriber(sender, i, cases[i].do_match ? kLong : kTick), cases[i].do_match)
        << i;
  }
}

TEST_F(Ros2NodeTest, LateSubscriberReceivesLatchedMessages) {
  Ros2Node sender(domain_, {});
  TfMessage message;
  message.transforms.emplace_back().child_frame_id = "child";
  const std::string bytes = BytesOf(message);
  sender.Publish(sender.Advertise("/tf_static", TfMessage::kType, kLatchedQos), bytes);
  sender.Publish(sender.Advertise("/tf", TfMessage::kType, kTransformsQos), bytes);
  Ros2Node receiver(domain_, {});
  receiver.Subscribe("/tf", TfMessage::kType, kTransformsQos);
  EXPECT_FALSE(Hear(&receiver, kShort));
  receiver.Subscribe("/tf_static", TfMessage::kType, kLatchedQos);
  EXPECT_EQ(Hear(&receiver, kLong), bytes);
}

TEST_F(Ros2NodeTest, ListsTopicsOfOtherNodes) {
  Ros2Node sender(domain_, {});
  sender.Advertise("/camera/image_raw", ImageMessage::kType, kSensorDataQos);
  sender.Advertise("/odom", OdometryMessage::kType, kDefaultQos);
  Ros2Node receiver(domain_, {});
  receiver.Advertise("/own", OdometryMessage::kType, kDefaultQos);
  std::vector<RosTopic> topics;
  for (const Time end = Now() + kLong; topics.size() < 2 && Now() < end;) {
    topics = receiver.Topics();
  }
  ASSERT_EQ(topics.size(), 2u);
  EXPECT_EQ(topics[0].name, "/camera/image_raw");
  EXPECT_EQ(topics[0].type, "sensor_msgs/Image");
  EXPECT_EQ(topics[1].type, "nav_msgs/Odometry");
  EXPECT_TRUE(sender.Topics().size() == 1 && sender.Topics()[0].name == "/own");
}

TEST_F(Ros2NodeTest, SeparatesDomains) {
  Ros2Node sender(domain_, {});
  Ros2Node receiver(domain_ + 100, {});
  const std::size_t publisher = sender.Advertise("/tf", TfMessage::kType, kDefaultQos);
  receiver.Subscribe("/tf", TfMessage::kType, kDefaultQos);
  EXPECT_FALSE(FindsSubscriber(sender, publisher, kShort));
  EXPECT_THROW(Ros2Node(233, {}), InputError);
}

}  // namespace
}  // namespace kestrel
