// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/landing_pattern.h"

#include <cmath>

#include <fmt/format.h>

namespace kestrel {

// Each comparison is written so that NaN violates it.
std::vector<std::string> LandingPattern::Validate() const {
  std::vector<std::string> violations;
  const auto require = [&violations](bool holds, const char* key, double value,
                                     const std::string& expected) {
    if (!holds) violations.push_back(fmt::format("{} is {}, expected {}", key, value, expected));
  };
  require(outer_diameter_m > 0 && std::isfinite(outer_diameter_m), "outer_diameter_m",
          outer_diameter_m, "a positive length");
  if (!violations.empty()) return violations;  // all other limits depend on the diameter

  require(ring_width_m > 0 && ring_width_m < outer_radius_m(), "ring_width_m", ring_width_m,
          fmt::format("more than 0 and less than the outer radius, {}", outer_radius_m()));
  require(arm_width_m > 0 && arm_width_m < inner_radius_m(), "arm_width_m", arm_width_m,
          fmt::format("more than 0 and less than the inner radius, {}", inner_radius_m()));
  require(arm_half_length_m > 0.5 * arm_width_m && arm_half_length_m <= outer_radius_m(),
          "arm_half_length_m", arm_half_length_m,
          fmt::format("more than half of arm_width_m and at most the outer radius, {}",
                      outer_radius_m()));
  require(board_size_m >= outer_diameter_m && std::isfinite(board_size_m), "board_size_m",
          board_size_m, fmt::format("at least the outer diameter, {}", outer_diameter_m));
  return violations;
}

}  // namespace kestrel
