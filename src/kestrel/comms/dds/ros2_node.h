// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "kestrel/core/base/time.h"
#include "kestrel/io/ros_messages/topic.h"

namespace kestrel {

// Delivery of a topic's messages. A subscriber hears only publishers that offer at least what it
// requests: reliable messages if it requests reliable ones, kept ones if it requests those.
struct Ros2Qos {
  bool is_reliable = true;  // false: best effort
  bool is_kept = false;     // the last are kept for late subscribers (transient local)
  int depth = 10;           // messages that wait for a slow reader
};
inline constexpr Ros2Qos kDefaultQos{};  // default of ROS
inline constexpr Ros2Qos kSensorDataQos{false, false, 5};
inline constexpr Ros2Qos kLatchedQos{true, true, 1};
inline constexpr Ros2Qos kTransformsQos{true, false, 100};

struct Ros2NodeOptions {
  std::string name = "kestrel";
  // True for a node that systems of ROS up to Humble see: nodes up to Humble and since Iron list
  // each other in different messages.
  bool is_humble = false;
};

// A node of ROS 2 without ROS: its topics go over Eclipse Cyclone DDS, by the names and types of
// ROS, and `ros2 node list` and `ros2 topic list` show them. Messages are plain CDR, as
// serialization.h writes and reads it. Publish and Take do not throw and may be called by different
// threads; the other functions are called before, by one thread. Subscriptions lie in inboxes, 0, 1
// and so on: each may have a thread of its own that takes from it.
class Ros2Node {
 public:
  // Throws InputError when there is no such domain (0 to 232), no network, or DDS is not part of
  // this build.
  Ros2Node(int domain, const Ros2NodeOptions& options);
  Ros2Node(const Ros2Node&) = delete;
  Ros2Node& operator=(const Ros2Node&) = delete;
  ~Ros2Node();

  // True when messages of the type ("sensor_msgs/Image") can be published and heard.
  static bool Knows(std::string_view type);

  // Returns the index of the publisher. 'topic': "/tf", "/kestrel/track". Throws InputError for an
  // unknown type, and where DDS refuses.
  std::size_t Advertise(const std::string& topic, std::string_view type, const Ros2Qos& qos);
  bool HasSubscribers(std::size_t publisher) const;
  // False when the bytes are not of the type, or DDS does not accept them.
  bool Publish(std::size_t publisher, std::string_view bytes);

  // Waits until all subscribers have what was published reliably, but not longer than 'timeout'.
  void Flush(Duration timeout) const;

  // Returns the index of the subscription in its inbox; otherwise as Advertise.
  std::size_t Subscribe(const std::string& topic, std::string_view type, const Ros2Qos& qos,
                        std::size_t inbox = 0);

  using TakeMessage = std::function<void(std::size_t subscriber, std::string_view bytes)>;
  // Passes everything that has come into the inbox to 'take', all of it of the topic's type; waits
  // for it until 'timeout' has passed. The inbox has a subscription.
  void Take(Duration timeout, const TakeMessage& take, std::size_t inbox = 0);

  // Returns the topics of ROS that others publish, each name and type once, in the order of names.
  // They are complete only a moment after the node has begun.
  std::vector<RosTopic> Topics() const;

 private:
  struct Entities;
  std::unique_ptr<Entities> entities_;
};

}  // namespace kestrel
