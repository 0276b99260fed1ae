// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/follow_options.h"

#include <cmath>

#include <fmt/format.h>

#include "kestrel/core/base/parse_number.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {

std::vector<std::string> FollowOptions::Validate() const {
  if (side == "free" || side == "behind" || Bearing()) return {};
  return {fmt::format("side is '{}', expected free, behind, or degrees from -360 to 360", side)};
}

std::optional<double> FollowOptions::Bearing() const {
  constexpr double kMostDegrees = 360;
  const auto degrees = ParseNumber<double>(side);
  if (!degrees || !(std::abs(*degrees) <= kMostDegrees)) return std::nullopt;
  return kPi / 2 - Radians(*degrees);
}

}  // namespace kestrel
