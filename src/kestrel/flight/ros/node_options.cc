// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/ros/node_options.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <variant>

#include "kestrel/core/base/options.h"
#include "kestrel/core/base/parse_number.h"
#include "kestrel/core/base/violations.h"
#include "kestrel/vision/pipeline/require_altitude.h"

namespace kestrel {
namespace {

// Options, or groups of them, that a running node can change. The pattern is not among them, as
// another pattern is another target.
constexpr std::array<std::string_view, 27> kChangeable = {
    "config",
    "pattern_frame",
    "target_frame",
    "publish_tf",
    "apriltag_topics",
    "altitude_m",
    "prediction_s",
    "prediction_step_s",
    "output",
    "force",
    "origin",
    "landing.detector",
    "landing.noise",
    "landing.position_by_altitude",
    "landing.target_height_m",
    "landing.track_yaw",
    "landing.altitude_hint",
    "landing.hint_sigma_m",
    "landing.hint_speed_mps",
    "landing.hint_age_s",
    "hunt.detector",
    "hunt.ground_height_m",
    "hunt.is_ground_flat",
    "hunt.ground_sigma_m",
    "hunt.track_count",
    "hunt.pose_sigma_m",
    "hunt.attitude_sigma_deg",
};
constexpr std::string_view kPattern = "landing.detector.pattern";

bool IsIn(std::string_view key, std::string_view group) {
  return key == group || (key.starts_with(group) && key[group.size()] == '.');
}

template <class Groups>
bool IsInOneOf(std::string_view key, const Groups& groups) {
  return std::any_of(groups.begin(), groups.end(),
                     [&](std::string_view group) { return IsIn(key, group); });
}

bool IsChangeable(std::string_view key) {
  return !IsIn(key, kPattern) && IsInOneOf(key, kChangeable);
}

}  // namespace

std::vector<std::string> NodeOptions::Validate() const {
  std::vector<std::string> violations = ros.Validate();
  AddViolations("landing", landing.Validate(), &violations);
  AddViolations("hunt", hunt.Validate(), &violations);
  AddViolations("fly", fly.Validate(), &violations);
  if (task != "landing" && task != "hunt") violations.push_back("task must be landing or hunt");
  if (image_transport != "raw" && image_transport != "compressed") {
    violations.push_back("image_transport must be raw or compressed");
  }
  if (poses != "topic" && poses != "tf" && poses != "none") {
    violations.push_back("poses must be topic, tf or none");
  }
  if (altitude_m != 0) RequireAltitude(altitude_m, "altitude_m", &violations);
  if (!origin.empty()) {
    const std::vector<double> degrees = origin_degrees();
    if (degrees.size() != 2 || std::abs(degrees[0]) >= 90 || std::abs(degrees[1]) > 180) {
      violations.push_back("origin must be latitude and longitude in degrees, as 50.1,14.4");
    }
  }
  return violations;
}

std::optional<double> NodeOptions::altitude() const {
  return altitude_m > 0 ? std::optional(altitude_m) : std::nullopt;
}

std::vector<double> NodeOptions::origin_degrees() const {
  const std::size_t comma = origin.find(',');
  if (comma == std::string::npos) return {};
  const auto latitude = ParseNumber<double>(std::string_view(origin).substr(0, comma));
  const auto longitude = ParseNumber<double>(std::string_view(origin).substr(comma + 1));
  if (!latitude || !longitude) return {};
  return {*latitude, *longitude};
}

OptionUpdate UpdateOptions(NodeOptions told, NodeOptions* options) {
  OptionUpdate update;
  const OptionFields from = FieldsOf(told);
  const OptionFields to = FieldsOf(*options);
  for (std::size_t i = 0; i < to.size(); ++i) {
    const auto take = [&](auto* value) {
      const auto& new_value = *std::get<decltype(value)>(from[i].value);
      if (*value == new_value) return;
      const bool is_changeable = IsChangeable(to[i].key);
      if (is_changeable) *value = new_value;
      (is_changeable ? update.taken : update.left).push_back(to[i].key);
    };
    std::visit(take, to[i].value);
  }
  return update;
}

}  // namespace kestrel
