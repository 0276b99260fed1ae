// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "kestrel/flight/ros/result_connection.h"
#include "kestrel/flight/ros1/ros1_connection.h"

namespace kestrel {

// Returns the message type in the form of ROS 1.
Ros1Connection::MessageType Ros1TypeOf(std::string_view type);

// Opens a node of ROS 1; Ctrl-C stays with the program. Throws InputError, whose text begins with
// 'asked_by', when there is no master.
std::shared_ptr<Ros1Connection> OpenRos1(const std::string& node, const std::string& asked_by);

// Publishes the results on topics of ROS 1.
class Ros1ResultConnection : public ResultConnection {
 public:
  Ros1ResultConnection(std::shared_ptr<Ros1Connection> ros, ResultTopics topics);

  bool HasSubscribers(ResultTopic topic) const override;
  void Publish(ResultTopic topic, const std::string& bytes) override;

 private:
  std::size_t Advertise(ResultTopic topic);

  std::shared_ptr<Ros1Connection> ros_;
  std::map<ResultTopic, std::size_t> topics_;  // index of each topic at the connection
};

}  // namespace kestrel
