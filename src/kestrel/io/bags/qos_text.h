// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace kestrel {

// Returns the quality of service of a topic as rosbag2 writes it: reliable; a latched topic keeps
// its last message for later subscribers.
inline std::string QosText(bool is_latched) {
  return std::string("- history: 1\n  depth: ") + (is_latched ? "1" : "10") +
         "\n  reliability: 1\n  durability: " + (is_latched ? "1" : "2") +
         "\n  deadline:\n    sec: 9223372036\n    nsec: 854775807\n"
         "  lifespan:\n    sec: 9223372036\n    nsec: 854775807\n"
         "  liveliness: 1\n"
         "  liveliness_lease_duration:\n    sec: 9223372036\n    nsec: 854775807\n"
         "  avoid_ros_namespace_conventions: false\n";
}

}  // namespace kestrel
