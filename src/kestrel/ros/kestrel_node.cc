// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "kestrel/bags/message_definitions.h"
#include "kestrel/base/error.h"
#include "kestrel/ros/landing_node.h"
#include "kestrel/ros/node_connection.h"
#include "kestrel/ros/node_options.h"
#include "kestrel/ros/ros1_connection.h"

namespace kestrel {
namespace {

constexpr std::uint32_t kPoseQueue = 200;

Ros1Connection::MessageType TypeOf(std::string_view type) {
  return {std::string(type), std::string(MessageChecksum(type)),
          MessageDefinition(type, WireFormat::kRos1)};
}

// The node's topics, in ROS 1.
class Ros1NodeConnection : public NodeConnection {
 public:
  explicit Ros1NodeConnection(Ros1Connection* ros) : ros_(ros) {
    for (const ResultTopicInfo& topic : kResultTopics) {
      topics_.push_back(ros_->Advertise(std::string(topic.name), TypeOf(topic.type)));
    }
  }

  bool HasSubscribers(ResultTopic topic) const override {
    return ros_->HasSubscribers(IndexOf(topic));
  }
  void Publish(ResultTopic topic, const std::string& bytes) override {
    ros_->Publish(IndexOf(topic), bytes);
  }
  void Warn(const std::string& text) override { ros_->Warn(text); }
  Time StampNow() const override { return TimeFromNanoseconds(ros_->NowNanoseconds()); }

 private:
  std::size_t IndexOf(ResultTopic topic) const { return topics_[static_cast<std::size_t>(topic)]; }

  Ros1Connection* ros_;
  std::vector<std::size_t> topics_;
};

// camera_info lies beside the image, as image_transport has it.
std::string BesideOf(const std::string& topic, const std::string& name) {
  return topic.substr(0, topic.rfind('/') + 1) + name;
}

void SubscribeCamera(const NodeOptions& options, Ros1Connection* ros, LandingNode* node) {
  const std::string image = ros->ResolvedName("image");
  if (options.image_transport == "compressed") {
    ros->Subscribe(image + "/compressed", TypeOf(CompressedImageMessage::kType), /*queue=*/1,
                   [node, image](const std::string&, const std::string& bytes) {
                     node->TakeCompressedImage(bytes, image);
                   });
  } else {
    ros->Subscribe(image, TypeOf(ImageMessage::kType), /*queue=*/1,
                   [node, image](const std::string&, const std::string& bytes) {
                     node->TakeImage(bytes, image);
                   });
  }
  const std::string camera_info = BesideOf(image, "camera_info");
  ros->Subscribe(camera_info, TypeOf(CameraInfoMessage::kType), /*queue=*/1,
                 [node, camera_info](const std::string&, const std::string& bytes) {
                   node->TakeCameraInfo(bytes, camera_info);
                 });
}

void SubscribePoses(const NodeOptions& options, Ros1Connection* ros, LandingNode* node) {
  if (options.poses == "none") return;
  for (const bool is_static : {true, false}) {
    const std::string topic = is_static ? "/tf_static" : "/tf";
    ros->Subscribe(topic, TypeOf(TfMessage::kType), kPoseQueue,
                   [=](const std::string&, const std::string& bytes) {
                     node->TakeTransforms(bytes, is_static, topic);
                   });
  }
  if (options.poses == "tf") return;
  const std::string poses = ros->ResolvedName("poses");
  ros->Subscribe(poses, {"*", "*", ""}, kPoseQueue,
                 [node, poses](const std::string& type, const std::string& bytes) {
                   node->TakePose(type, bytes, poses);
                 });
}

void OfferServices(Ros1Connection* ros, LandingNode* node) {
  ros->Offer("start", [node] {
    node->Start();
    return std::string();
  });
  ros->Offer("stop", [node] {
    node->Stop();
    return std::string();
  });
  ros->Offer("reset", [ros, node] {
    try {
      node->Reset(ReadNodeOptions(ros->Parameters()));
      return std::string();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  });
}

int RunNode(int argc, char** argv) {
  Ros1Connection ros(&argc, argv, "kestrel");
  if (argc > 1) {
    fmt::print(stderr,
               "kestrel_node: unknown argument '{}'; parameters are given as _name:=value\n",
               argv[1]);
    return 2;
  }
  if (!ros.HasMaster()) {
    fmt::print(stderr, "kestrel_node: no ROS master at {}; start roscore\n",
               std::getenv("ROS_MASTER_URI") ? std::getenv("ROS_MASTER_URI") : "ROS_MASTER_URI");
    return 1;
  }
  const NodeOptions options = ReadNodeOptions(ros.Parameters());
  Ros1NodeConnection connection(&ros);
  LandingNode node(options, &connection);
  SubscribeCamera(options, &ros, &node);
  SubscribePoses(options, &ros, &node);
  OfferServices(&ros, &node);
  ros.Spin([&node] { node.PublishDiagnostics(); });
  return 0;
}

}  // namespace
}  // namespace kestrel

int main(int argc, char** argv) {
  try {
    return kestrel::RunNode(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "kestrel_node: {}\n", error.what());
    return 1;
  }
}
