// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// ROS 1 as far as the node needs it: serialized messages in and out. The headers of ROS do not
// compile as C++20: only ros1_connection.cc, which is C++17, includes them, and this header is
// C++17.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace kestrel {

class Ros1Connection {
 public:
  // A message type of ROS: name ("sensor_msgs/Image"), checksum of its definition, and definition.
  struct MessageType {
    std::string name;
    std::string checksum;
    std::string definition;
  };
  struct Answer {
    bool success = true;
    std::string message;
  };
  using Service = std::function<Answer()>;
  using TakeMessage = std::function<void(const std::string& type, const std::string& bytes)>;

  // Takes the arguments of ROS (remappings, parameters) out of the command line. HasMaster() is
  // false when there is no master. 'handles_interrupts': Ctrl-C ends Spin.
  Ros1Connection(int* argc, char** argv, const std::string& node, bool handles_interrupts);
  ~Ros1Connection();
  bool HasMaster() const;

  // Returns the private parameters as text; groups are joined by dots
  // ("landing.detector.min_quality").
  std::vector<std::pair<std::string, std::string>> Parameters() const;

  // Returns 'topic' with its namespace and remapping.
  std::string ResolvedName(const std::string& topic) const;

  // The thread of Spin calls 'take' for each message. A type with the name "*" matches any type.
  void Subscribe(const std::string& topic, const MessageType& type, std::uint32_t queue,
                 const TakeMessage& take);

  // Advertises a topic below the node's own name, unless it begins with a slash. The newest message
  // of a latched topic is kept for later subscribers. Returns the topic's index.
  std::size_t Advertise(const std::string& topic, const MessageType& type, bool is_latched);
  bool HasSubscribers(std::size_t topic) const;
  void Publish(std::size_t topic, const std::string& bytes);

  // Offers a std_srvs/Trigger service below the node's own name; the thread of Spin calls it.
  void Offer(const std::string& name, const Service& service);

  // Calls 'tick' once a second, until Ctrl-C or the master ends the node.
  void Spin(const std::function<void()>& tick);

  void Warn(const std::string& text) const;
  std::int64_t NowNanoseconds() const;  // time of ROS, which a simulation may set

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace kestrel
