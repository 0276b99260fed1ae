// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace kestrel {

// "RIHS01_" and 64 hexadecimal digits: by what ROS 2 (since Iron) compares the definitions of a
// type that two nodes have (REP 2016). It is the SHA-256 of the type's fields, and those of all
// types in them, in JSON. 'type', as MessageDefinition knows it: "sensor_msgs/Image".
std::string TypeHash(std::string_view type);

}  // namespace kestrel
