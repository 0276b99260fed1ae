// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/ros/node_options.h"

#include <fmt/format.h>

#include "kestrel/base/options.h"
#include "kestrel/base/violations.h"

namespace kestrel {

std::vector<std::string> NodeOptions::Validate() const {
  std::vector<std::string> violations = kestrel.Validate();
  if (image_transport != "raw" && image_transport != "compressed") {
    violations.push_back("image_transport must be raw or compressed");
  }
  if (poses != "topic" && poses != "tf" && poses != "none") {
    violations.push_back("poses must be topic, tf or none");
  }
  if (body_frame.empty()) violations.push_back("body_frame must not be empty");
  if (pattern_frame.empty()) violations.push_back("pattern_frame must not be empty");
  if (target_frame.empty()) violations.push_back("target_frame must not be empty");
  RequireIn(altitude_m, 0, 1000, "altitude_m", &violations);
  RequireIn(prediction_s, 0, 60, "prediction_s", &violations);
  RequireIn(prediction_step_s, 0.01, 60, "prediction_step_s", &violations);
  return violations;
}

NodeOptions ReadNodeOptions(const std::vector<std::pair<std::string, std::string>>& parameters) {
  NodeOptions options;
  for (const auto& [key, value] : parameters) {
    if (key == "config" && !value.empty()) ReadOptions(value, &options.kestrel);
  }
  for (const auto& [key, value] : parameters) SetOption(fmt::format("{}={}", key, value), &options);
  RequireValid(options);
  return options;
}

}  // namespace kestrel
