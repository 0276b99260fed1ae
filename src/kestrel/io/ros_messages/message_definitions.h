// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "kestrel/io/ros_messages/topic.h"

namespace kestrel {

// Returns the definition of a type with those of the types in it, as bags contain it: in the words
// of ROS 1 or of ROS 2. Arguments and errors are those of DescribeType.
std::string MessageDefinition(std::string_view type, WireFormat format);

// Returns the checksum of a type's definition in ROS 1: 32 hexadecimal digits.
std::string MessageChecksum(std::string_view type);

// Returns the hash by which ROS 2 (since Iron) compares two nodes' definitions of a type (REP
// 2016): "RIHS01_" and 64 hexadecimal digits, the SHA-256 of the JSON description of the type's
// fields and of all types in them.
std::string TypeHash(std::string_view type);

}  // namespace kestrel
