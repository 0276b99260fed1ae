// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// ROS 1 as far as the node needs it: serialized messages in and out. Its own headers do not compile
// as C++20, so that only ros1_connection.cc includes them, and this is C++17.

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
  // As ROS knows a type of messages: "sensor_msgs/Image", the checksum of its definition, and that.
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

  // Takes the arguments of ROS (remappings, parameters) out of the command line. False from
  // HasMaster: there is no master. 'handles_interrupts': Ctrl-C ends Spin.
  Ros1Connection(int* argc, char** argv, const std::string& node, bool handles_interrupts);
  ~Ros1Connection();
  bool HasMaster() const;

  // The private parameters, groups joined by dots ("landing.detector.min_quality"), as text.
  std::vector<std::pair<std::string, std::string>> Parameters() const;

  // 'topic' as it is remapped, with its namespace.
  std::string ResolvedName(const std::string& topic) const;

  // Calls 'take' by the thread of Spin. A type with the name "*" is any.
  void Subscribe(const std::string& topic, const MessageType& type, std::uint32_t queue,
                 const TakeMessage& take);

  // A topic below the node's own name, unless it begins with a slash; of a latched one the newest
  // message is kept for those who come later. Returns its index.
  std::size_t Advertise(const std::string& topic, const MessageType& type, bool is_latched);
  bool HasSubscribers(std::size_t topic) const;
  void Publish(std::size_t topic, const std::string& bytes);

  // std_srvs/Trigger below the node's own name; called by the thread of Spin.
  void Offer(const std::string& name, const Service& service);

  // Calls 'tick' once a second, until Ctrl-C or the master ends the node.
  void Spin(const std::function<void()>& tick);

  void Warn(const std::string& text) const;
  std::int64_t NowNanoseconds() const;  // ROS' time, which a simulation may set

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace kestrel
