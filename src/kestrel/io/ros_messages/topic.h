// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "kestrel/core/base/shown.h"

namespace kestrel {

// Serialization of a topic's messages.
enum class WireFormat {
  kRos1,      // ROS 1
  kCdr,       // ROS 2: XCDR1 after a header of four bytes
  kProtobuf,  // messages of Foxglove, by the types of ROS that they correspond to
  kOther,     // JSON, other messages in protobuf, ...: not read
};

// A topic of a bag or of nodes.
struct RosTopic {
  std::string name;  // "/camera/image_raw"
  std::string type;  // "sensor_msgs/Image", for ROS 2 too
  WireFormat wire_format = WireFormat::kOther;
  std::optional<std::uint64_t> messages;  // number of messages, if the bag has it
};

// Returns the type's name in the form used here: "sensor_msgs/Image" for "sensor_msgs/msg/Image".
std::string NormalTypeName(std::string_view type);
// Returns "sensor_msgs/msg/Image" for "sensor_msgs/Image".
std::string Ros2TypeName(std::string_view type);

// Returns the name of a topic or type in a form for messages and results: characters that ROS
// allows in names are unchanged, characters that would break a line are replaced.
inline std::string PlainTopicName(std::string_view name) {
  constexpr std::size_t kMaxLength = 256;
  return Shown(name, kMaxLength);
}

}  // namespace kestrel
