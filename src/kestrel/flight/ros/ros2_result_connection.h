// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <string>

#include "kestrel/comms/dds/ros2_node.h"
#include "kestrel/flight/session/result_connection.h"

namespace kestrel {

// Publishes the results on topics of ROS 2.
class Ros2ResultConnection : public ResultConnection {
 public:
  // Topics without a slash are below 'name'. Throws InputError where DDS refuses.
  Ros2ResultConnection(std::shared_ptr<Ros2Node> node, std::string name, ResultTopics topics);

  bool HasSubscribers(ResultTopic topic) const override;
  void Publish(ResultTopic topic, const std::string& bytes) override;
  void Flush() override;

 private:
  std::size_t Advertise(ResultTopic topic);

  std::shared_ptr<Ros2Node> node_;
  std::string name_;
  std::map<ResultTopic, std::size_t> publishers_;
};

}  // namespace kestrel
