// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "kestrel/app/ros_node/node_parameters.h"
#include "kestrel/core/base/error.h"
#include "kestrel/flight/ros/node_connection.h"
#include "kestrel/flight/ros/node_options.h"
#include "kestrel/flight/ros/ros_node.h"
#include "kestrel/flight/ros1/ros1_result_connection.h"
#include "kestrel/flight/ros1/ros1_subscriptions.h"

namespace kestrel {
namespace {

constexpr std::array kHuntNodeTopics = {
    ResultTopic::kDetections,  ResultTopic::kMarkers, ResultTopic::kAnnotatedImage,
    ResultTopic::kDiagnostics, ResultTopic::kMap,     ResultTopic::kMapMarkers};

// The node's topics in ROS 1.
class Ros1NodeConnection : public NodeConnection {
 public:
  Ros1NodeConnection(const std::shared_ptr<Ros1Connection>& ros, ResultTopics topics)
      : ros_(ros), results_(ros, topics) {}

  bool HasSubscribers(ResultTopic topic) const override { return results_.HasSubscribers(topic); }
  void Publish(ResultTopic topic, const std::string& bytes) override {
    results_.Publish(topic, bytes);
  }
  void Warn(const std::string& text) override { ros_->Warn(text); }
  Time StampNow() const override { return TimeFromNanoseconds(ros_->NowNanoseconds()); }

 private:
  std::shared_ptr<Ros1Connection> ros_;
  Ros1ResultConnection results_;
};

Ros1SourceTopics TopicsOf(const NodeOptions& options) {
  Ros1SourceTopics topics;
  topics.is_compressed = options.image_transport == "compressed";
  topics.has_transforms = options.has_poses();
  if (options.poses == "topic") topics.poses = "poses";
  return topics;
}

// Returns the text of 'action', or its error.
Ros1Connection::Answer AnswerBy(const std::function<std::string()>& action) {
  try {
    return {true, action()};
  } catch (const InputError& error) {
    return {false, error.what()};
  }
}

void OfferServices(Ros1Connection* ros, RosNode* node) {
  const auto offer = [ros](const char* name, const std::function<std::string()>& action) {
    ros->Offer(name, [action] { return AnswerBy(action); });
  };
  offer("start", [node] {
    node->Start();
    return "";
  });
  offer("stop", [node] {
    node->Stop();
    return "";
  });
  offer("reset", [ros, node] {
    node->Reset(ReadNodeOptions(ros->Parameters()));
    return "";
  });
  offer("update", [ros, node] { return node->Update(ReadNodeOptions(ros->Parameters())); });
  offer("save_map", [node] { return node->SaveMap(); });
}

int RunNode(int argc, char** argv) {
  const auto ros =
      std::make_shared<Ros1Connection>(&argc, argv, "kestrel", /*handles_interrupts=*/true);
  if (argc > 1) {
    fmt::print(stderr,
               "kestrel_node: unknown argument '{}'; parameters are given as _name:=value\n",
               argv[1]);
    return 2;
  }
  if (!ros->HasMaster()) {
    fmt::print(stderr, "kestrel_node: no ROS master at {}; start roscore\n",
               std::getenv("ROS_MASTER_URI") ? std::getenv("ROS_MASTER_URI") : "ROS_MASTER_URI");
    return 1;
  }
  const NodeOptions options = ReadNodeOptions(ros->Parameters());
  Ros1NodeConnection connection(ros,
                                options.is_hunt() ? ResultTopics(kHuntNodeTopics) : kLandingTopics);
  RosNode node(options, &connection);
  SubscribeTo(
      TopicsOf(options), ros.get(),
      [&node](const BagTopic& topic, const std::string& bytes) { node.Take(topic, bytes); });
  OfferServices(ros.get(), &node);
  ros->Spin([&node] { node.Tick(); });
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
