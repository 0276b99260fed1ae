// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/guidance_options.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "kestrel/core/base/parse_number.h"
#include "kestrel/core/base/violations.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

constexpr char kAnyHeading[] = "any";

}  // namespace

std::vector<std::string> GuidanceOptions::Validate() const {
  std::vector<std::string> violations;
  RequireIn(leg_m, 0, 2, "leg_m", &violations);
  RequireIn(search_altitude_m, 1, 100, "search_altitude_m", &violations);
  RequireIn(search_wait_s, 0, 3600, "search_wait_s", &violations);
  RequireIn(search_radius_m, 0, 1000, "search_radius_m", &violations);
  RequireIn(search_speed_mps, 0.5, 20, "search_speed_mps", &violations);
  RequireIn(search_distance_m, 1, 10000, "search_distance_m", &violations);
  RequireIn(search_limit_s, 1, 3600, "search_limit_s", &violations);
  RequireIn(cannot_follow_s, 0, 3600, "cannot_follow_s", &violations);
  RequireIn(follow_height_m, 0.1, 100, "follow_height_m", &violations);
  RequireIn(glide, 0, 10, "glide", &violations);
  RequireIn(position_gain, 0.1, 5, "position_gain", &violations);
  RequireIn(braking, 0.1, 20, "braking", &violations);
  RequireIn(autopilot_jerk, 0, 1000, "autopilot_jerk", &violations);
  RequireIn(integral_gain, 0, 5, "integral_gain", &violations);
  RequireIn(smoothing_s, 0.01, 10, "smoothing_s", &violations);
  RequireIn(sink_gain, 0.05, 5, "sink_gain", &violations);
  RequireIn(touchdown_sink_mps, 0.1, 10, "touchdown_sink_mps", &violations);
  RequireIn(cone_m, 0.01, 10, "cone_m", &violations);
  RequireIn(cone_slope, 0, 10, "cone_slope", &violations);
  RequireIn(commit_height_m, 0, 1, "commit_height_m", &violations);
  if (touchdown_heading != kAnyHeading && !HeadingOverPad()) {
    violations.push_back(fmt::format(
        "touchdown_heading is '{}', expected degrees from -360 to 360, or any", touchdown_heading));
  }
  RequireIn(heading_tolerance_deg, 0.5, 45, "heading_tolerance_deg", &violations);
  RequireIn(heading_wait_s, 1, 3600, "heading_wait_s", &violations);
  RequireIn(max_turn_dps, 1, 360, "max_turn_dps", &violations);
  RequireIn(max_sigma_m, 0.01, 10, "max_sigma_m", &violations);
  RequireIn(sight_s, 0.05, 3, "sight_s", &violations);
  RequireIn(sight_height_m, commit_height_m, 100, "sight_height_m", &violations);
  RequireIn(commit_sight_s, sight_s, 3, "commit_sight_s", &violations);
  RequireIn(max_target_climb_mps, 0.1, 10, "max_target_climb_mps", &violations);
  RequireIn(hold_pose_s, 0, 2, "hold_pose_s", &violations);
  RequireIn(lose_pose_s, hold_pose_s, 10, "lose_pose_s", &violations);
  RequireIn(lose_camera_s, sight_s, 3600, "lose_camera_s", &violations);
  RequireIn(lose_link_s, 0.1, 10, "lose_link_s", &violations);
  RequireIn(disobey_mps, 0.5, 20, "disobey_mps", &violations);
  RequireIn(disobey_s, 1, 60, "disobey_s", &violations);
  RequireIn(disarm_after_s, 0, 60, "disarm_after_s", &violations);
  RequireIn(disarm_carried_s, 0, 60, "disarm_carried_s", &violations);
  AddViolations("contact", contact.Validate(), &violations);
  AddViolations("stale", stale.Validate(), &violations);
  AddViolations("limits", limits.Validate(), &violations);
  AddViolations("model", model.Validate(), &violations);
  if (search_altitude_m < limits.floor_m || search_altitude_m > limits.ceiling_m) {
    violations.push_back("search_altitude_m is not between limits.floor_m and limits.ceiling_m");
  }
  return violations;
}

GuidanceOptions GuidanceOptions::WithinSight(double range_m) const {
  constexpr double kLeastSearch_m = 1, kLeastFollow_m = 0.5;
  constexpr double kAside = 0.8;  // a target beside the UAV is farther away, and seen obliquely
  GuidanceOptions options = *this;
  const double search_m = std::max({kAside * range_m, limits.floor_m, kLeastSearch_m});
  options.search_altitude_m = std::min(search_altitude_m, search_m);
  // From lower the camera sees less to the sides: a spiral covers what is missing.
  options.search_radius_m =
      std::max(search_radius_m, search_altitude_m - options.search_altitude_m);
  const double follow_m = std::max(kAside * range_m - leg_m, kLeastFollow_m);
  options.follow_height_m = std::min(follow_height_m, follow_m);
  return options;
}

std::optional<double> GuidanceOptions::HeadingOverPad() const {
  constexpr double kMostDegrees = 360;
  const auto degrees = ParseNumber<double>(touchdown_heading);
  if (!degrees || !(std::abs(*degrees) <= kMostDegrees)) return std::nullopt;
  return Radians(*degrees);
}

}  // namespace kestrel
