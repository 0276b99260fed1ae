// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/ros/dds_options.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "kestrel/core/base/violations.h"

namespace kestrel {
namespace {

constexpr std::array<std::string_view, 6> kDistributions{"humble", "iron",    "jazzy",
                                                         "kilted", "lyrical", "rolling"};

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
  if (body_frame.empty()) violations.push_back("body_frame must not be empty");
  if (pattern_frame.empty()) violations.push_back("pattern_frame must not be empty");
  if (target_frame.empty()) violations.push_back("target_frame must not be empty");
  RequireIn(prediction_s, 0, 60, "prediction_s", &violations);
  RequireIn(prediction_step_s, 0.01, 60, "prediction_step_s", &violations);
  if (!IsNodeName(node)) {
    violations.push_back(
        fmt::format("node is '{}', expected letters, digits and '_', and no digit at first", node));
  }
  if (std::find(kDistributions.begin(), kDistributions.end(), distribution) ==
      kDistributions.end()) {
    violations.push_back(fmt::format("distribution is '{}', expected one of {}", distribution,
                                     fmt::join(kDistributions, ", ")));
  }
  RequireIn(wait_s, 0, 600, "wait_s", &violations);
  return violations;
}

}  // namespace kestrel
