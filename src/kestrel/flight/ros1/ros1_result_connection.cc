// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/ros1/ros1_result_connection.h"

#include <cstdlib>
#include <utility>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/io/bags/message_definitions.h"
#include "kestrel/io/bags/serialization.h"

namespace kestrel {

Ros1Connection::MessageType Ros1TypeOf(std::string_view type) {
  return {std::string(type), std::string(MessageChecksum(type)),
          MessageDefinition(type, WireFormat::kRos1)};
}

std::shared_ptr<Ros1Connection> OpenRos1(const std::string& node, const std::string& asked_by) {
  int no_arguments = 0;
  auto ros = std::make_shared<Ros1Connection>(&no_arguments, nullptr, node,
                                              /*handles_interrupts=*/false);
  if (ros->HasMaster()) return ros;
  const char* const uri = std::getenv("ROS_MASTER_URI");
  throw InputError(fmt::format("{}: no ROS master at {}; start roscore", asked_by,
                               uri != nullptr ? uri : "ROS_MASTER_URI"));
}

Ros1ResultConnection::Ros1ResultConnection(std::shared_ptr<Ros1Connection> ros, ResultTopics topics)
    : ros_(std::move(ros)) {
  for (const ResultTopic topic : topics) Advertise(topic);
}

std::size_t Ros1ResultConnection::Advertise(ResultTopic topic) {
  const ResultTopicInfo& info = InfoOf(topic);
  return topics_[topic] =
             ros_->Advertise(std::string(info.name), Ros1TypeOf(info.type), info.is_latched);
}

bool Ros1ResultConnection::HasSubscribers(ResultTopic topic) const {
  const auto known = topics_.find(topic);
  return known != topics_.end() && ros_->HasSubscribers(known->second);
}

void Ros1ResultConnection::Publish(ResultTopic topic, const std::string& bytes) {
  const auto known = topics_.find(topic);
  ros_->Publish(known != topics_.end() ? known->second : Advertise(topic), bytes);
}

}  // namespace kestrel
