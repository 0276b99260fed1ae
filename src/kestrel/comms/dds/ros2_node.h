// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "kestrel/core/base/time.h"
#include "kestrel/io/bags/bag_reader.h"

namespace kestrel {

// How a topic's messages are delivered. A subscriber hears a publisher that offers as much as it
// asks for: reliable messages for one that asks for such, kept ones for one that came late.
struct Ros2Qos {
  bool is_reliable = true;  // else best effort
  bool is_kept = false;     // the last for those that come late (transient local)
  int depth = 10;           // messages that wait for a slow reader
};
inline constexpr Ros2Qos kDefaultQos{};  // ROS' own
inline constexpr Ros2Qos kSensorDataQos{false, false, 5};
inline constexpr Ros2Qos kLatchedQos{true, true, 1};
inline constexpr Ros2Qos kTransformsQos{true, false, 100};

struct Ros2NodeOptions {
  std::string name = "kestrel";
  // Distribution of ROS that is to see the node: nodes up to Humble and since Iron list each other
  // in different words.
  bool is_humble = false;
};

// A node of ROS 2 without ROS: its topics over Eclipse Cyclone DDS, by ROS' names and types, and
// seen by `ros2 node list` and `ros2 topic list`. Messages are plain CDR, as serialization.h writes
// and reads it. Publish and Take do not throw and may be called by different threads; the others
// before that, by one.
class Ros2Node {
 public:
  // Throws InputError when there is no such domain (0 to 232), no network, or DDS is not part of
  // this build.
  Ros2Node(int domain, const Ros2NodeOptions& options);
  Ros2Node(const Ros2Node&) = delete;
  Ros2Node& operator=(const Ros2Node&) = delete;
  ~Ros2Node();

  // Whether messages of the type ("sensor_msgs/Image") can be published and heard.
  static bool Knows(std::string_view type);

  // Returns its index among those that are published. 'topic': "/tf", "/kestrel/track". Throws
  // InputError for a type that is not known, and where DDS refuses.
  std::size_t Advertise(const std::string& topic, std::string_view type, const Ros2Qos& qos);
  bool HasSubscribers(std::size_t publisher) const;
  // False where the bytes are not of the type, or DDS does not take them.
  bool Publish(std::size_t publisher, std::string_view bytes);

  // Waits until those who hear have what was published reliably, but not longer than 'timeout'.
  void Flush(Duration timeout) const;

  // Returns its index among those that are heard, as Advertise.
  std::size_t Subscribe(const std::string& topic, std::string_view type, const Ros2Qos& qos);

  using TakeMessage = std::function<void(std::size_t subscriber, std::string_view bytes)>;
  // Gives 'take' what has come, all of it of the topic's type; waits for that until 'timeout' has
  // passed.
  void Take(Duration timeout, const TakeMessage& take);

  // What others publish of ROS' topics, each name and type once, in the order of names. Takes a
  // moment from the node's birth on.
  std::vector<BagTopic> Topics() const;

 private:
  struct Entities;
  std::unique_ptr<Entities> entities_;
};

}  // namespace kestrel
