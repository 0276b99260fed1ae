// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "kestrel/io/ros_messages/topic.h"

namespace kestrel {

struct FieldDescription {
  std::string type;  // as "uint8[]", "float64[9]", "string<=256", "std_msgs/Header"
  std::string name;
};

// A type of ROS as its definition has it.
struct TypeDescription {
  std::string_view type;       // as "sensor_msgs/Image"
  std::string_view constants;  // lines as "int32 ADD=0"
  std::vector<FieldDescription> fields;
};

// Returns the description of a type, and of the types in it, each once, in the order of their
// occurrence. 'type': one of messages.h, or in ROS 2 also of the other headers of messages.
// 'format': kRos1 or kCdr. Throws InputError for another type.
std::vector<TypeDescription> DescribeType(std::string_view type, WireFormat format);

// Names of the types of ROS 2 that occur in no other.
const std::vector<std::string_view>& Ros2Types();

}  // namespace kestrel
