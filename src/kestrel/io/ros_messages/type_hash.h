// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace kestrel {

// Returns the hash by which ROS 2 (since Iron) compares two nodes' definitions of a type (REP
// 2016): "RIHS01_" and 64 hexadecimal digits, the SHA-256 of the JSON description of the type's
// fields and of all types in them. 'type' is named as in MessageDefinition: "sensor_msgs/Image".
std::string TypeHash(std::string_view type);

}  // namespace kestrel
