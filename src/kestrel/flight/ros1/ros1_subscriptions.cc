// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/ros1/ros1_subscriptions.h"

#include <cstdint>
#include <string_view>

#include "kestrel/flight/ros/topic_source.h"
#include "kestrel/flight/ros1/ros1_result_connection.h"
#include "kestrel/io/bags/messages.h"

namespace kestrel {
namespace {

constexpr std::uint32_t kNewest = 1;
constexpr std::uint32_t kPoseQueue = 200;

}  // namespace

void SubscribeTo(const Ros1SourceTopics& topics, Ros1Connection* ros,
                 const std::function<void(const BagTopic&, const std::string& bytes)>& take) {
  // 'name': what the messages are called.
  const auto subscribe = [&](const std::string& topic, const Ros1Connection::MessageType& type,
                             std::uint32_t queue, const std::string& name) {
    ros->Subscribe(topic, type, queue,
                   [take, name](const std::string& message_type, const std::string& bytes) {
                     take({name, message_type, WireFormat::kRos1, {}}, bytes);
                   });
  };
  const std::string image = ros->ResolvedName(topics.image);
  if (topics.is_compressed) {
    subscribe(image + "/compressed", Ros1TypeOf(CompressedImageMessage::kType), kNewest, image);
  } else {
    subscribe(image, Ros1TypeOf(ImageMessage::kType), kNewest, image);
  }
  const std::string camera_info = image.substr(0, image.rfind('/') + 1) + "camera_info";
  subscribe(camera_info, Ros1TypeOf(CameraInfoMessage::kType), kNewest, camera_info);
  if (topics.has_transforms) {
    for (const char* const tf : {kStaticTfTopic, "/tf"}) {
      subscribe(tf, Ros1TypeOf(TfMessage::kType), kPoseQueue, tf);
    }
  }
  if (topics.poses.empty()) return;
  const std::string poses = ros->ResolvedName(topics.poses);
  subscribe(poses, {"*", "*", ""}, kPoseQueue, poses);
}

}  // namespace kestrel
