// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/ros_messages/topic.h"

#include <fmt/format.h>

namespace kestrel {

std::string NormalTypeName(std::string_view type) {
  constexpr std::string_view kMiddle = "/msg/";
  const std::size_t middle = type.find(kMiddle);
  if (middle == std::string_view::npos) return std::string(type);
  return fmt::format("{}/{}", type.substr(0, middle), type.substr(middle + kMiddle.size()));
}

std::string Ros2TypeName(std::string_view type) {
  const std::size_t slash = type.find('/');
  return fmt::format("{}/msg{}", type.substr(0, slash), type.substr(slash));
}

}  // namespace kestrel
