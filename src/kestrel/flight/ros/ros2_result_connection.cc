// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/ros/ros2_result_connection.h"

#include <chrono>
#include <utility>

#include <fmt/format.h>

namespace kestrel {
namespace {

Ros2Qos QosOf(ResultTopic topic) {
  if (InfoOf(topic).is_latched) return kLatchedQos;
  if (topic == ResultTopic::kAnnotatedImage) return kSensorDataQos;
  return topic == ResultTopic::kTransforms ? kTransformsQos : kDefaultQos;
}

}  // namespace

Ros2ResultConnection::Ros2ResultConnection(std::shared_ptr<Ros2Node> node, std::string name,
                                           ResultTopics topics)
    : node_(std::move(node)), name_(std::move(name)) {
  for (const ResultTopic topic : topics) Advertise(topic);
}

std::size_t Ros2ResultConnection::Advertise(ResultTopic topic) {
  const ResultTopicInfo& info = InfoOf(topic);
  const std::string full_name =
      info.name.starts_with('/') ? std::string(info.name) : fmt::format("/{}/{}", name_, info.name);
  return publishers_[topic] = node_->Advertise(full_name, info.type, QosOf(topic));
}

bool Ros2ResultConnection::HasSubscribers(ResultTopic topic) const {
  const auto known = publishers_.find(topic);
  return known != publishers_.end() && node_->HasSubscribers(known->second);
}

void Ros2ResultConnection::Publish(ResultTopic topic, const std::string& bytes) {
  const auto known = publishers_.find(topic);
  const std::size_t publisher = known != publishers_.end() ? known->second : Advertise(topic);
  // A message that DDS does not accept is lost, as on a network.
  static_cast<void>(node_->Publish(publisher, bytes));
}

void Ros2ResultConnection::Flush() { node_->Flush(std::chrono::seconds(1)); }

}  // namespace kestrel
