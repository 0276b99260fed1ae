// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/guidance_options.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/base/parse_number.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

constexpr char kAnyHeading[] = "any";

}  // namespace

std::vector<std::string> GuidanceOptions::Validate() const {
  std::vector<std::string> violations;
  if (touchdown_heading != kAnyHeading && !HeadingOverPad()) {
    violations.push_back(fmt::format(
        "touchdown_heading is '{}', expected degrees from -360 to 360, or any", touchdown_heading));
  }
  Require(sight_height_m, Range{commit_height_m, 100}, "sight_height_m", &violations);
  Require(lose_camera_s, Range{sight_s, 3600}, "lose_camera_s", &violations);
  Require(search_altitude_m, Range{limits.floor_m, limits.ceiling_m}, "search_altitude_m",
          &violations);
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
