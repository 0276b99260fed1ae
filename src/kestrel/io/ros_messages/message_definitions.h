// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "kestrel/io/ros_messages/topic.h"

namespace kestrel {

// Returns the definition of a type of messages.h, or in ROS 2 of result_messages.h, with those of
// the types in it, as bags contain it: in the words of ROS 1 or of ROS 2 ('format': kRos1, kCdr).
std::string MessageDefinition(std::string_view type, WireFormat format);

// Returns the checksum of the definition of a type of messages.h in ROS 1.
std::string_view MessageChecksum(std::string_view type);

}  // namespace kestrel
