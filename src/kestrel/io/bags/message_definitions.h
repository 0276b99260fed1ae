// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "kestrel/io/bags/bag_reader.h"

namespace kestrel {

// The definition of a type of messages.h or result_messages.h, with those of the types in it, as
// bags have it: in ROS 1's or in ROS 2's words ('format': kRos1, kCdr).
std::string MessageDefinition(std::string_view type, WireFormat format);

// The checksum by which ROS 1 knows the definition.
std::string_view MessageChecksum(std::string_view type);

// "sensor_msgs/msg/Image" for "sensor_msgs/Image".
std::string Ros2TypeName(std::string_view type);

}  // namespace kestrel
