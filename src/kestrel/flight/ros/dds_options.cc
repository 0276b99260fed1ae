// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/ros/dds_options.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace kestrel {
namespace {

// True when ROS accepts 'name' as the name of a node.
bool IsNodeName(const std::string& name) {
  constexpr std::size_t kMaxLength = 255;
  return !name.empty() && name.size() <= kMaxLength &&
         std::isdigit(static_cast<unsigned char>(name.front())) == 0 &&
         std::all_of(name.begin(), name.end(),
                     [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
}

}  // namespace

std::vector<std::string> DdsOptions::Validate() const {
  std::vector<std::string> violations;
  if (body_frame.empty()) violations.push_back("body_frame is empty, expected a name");
  if (pattern_frame.empty()) violations.push_back("pattern_frame is empty, expected a name");
  if (target_frame.empty()) violations.push_back("target_frame is empty, expected a name");
  if (!IsNodeName(node)) {
    violations.push_back(
        fmt::format("node is '{}', expected letters, digits and '_', and no digit at first", node));
  }
  return violations;
}

}  // namespace kestrel
