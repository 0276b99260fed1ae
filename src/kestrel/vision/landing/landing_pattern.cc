// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/landing_pattern.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "kestrel/vision/target/closed_lines.h"

namespace kestrel {
namespace {

// The corners of both arms' outline: one between two arms and two at each end, four times.
std::vector<Eigen::Vector2d> CornersOfCross(const LandingPattern& pattern) {
  const double half_width = 0.5 * pattern.arm_width_m;
  const double length = std::min(pattern.arm_half_length_m, pattern.inner_radius_m());
  std::vector<Eigen::Vector2d> corners;
  for (int quarter = 0; quarter < 4; ++quarter) {
    const Eigen::Rotation2Dd turn(quarter * std::numbers::pi / 2);
    corners.emplace_back(turn * Eigen::Vector2d(half_width, -half_width));
    corners.emplace_back(turn * Eigen::Vector2d(length, -half_width));
    corners.emplace_back(turn * Eigen::Vector2d(length, half_width));
  }
  return corners;
}

}  // namespace

std::vector<std::string> LandingPattern::Validate() const {
  std::vector<std::string> violations;
  const auto require = [&violations](bool holds, const char* key, double value,
                                     const std::string& expected) {
    if (!holds)
      violations.push_back(fmt::format("{} is {:.7g}, expected {}", key, value, expected));
  };
  require(ring_width_m < outer_radius_m(), "ring_width_m", ring_width_m,
          fmt::format("less than the outer radius, {:g}", outer_radius_m()));
  require(arm_width_m < inner_radius_m(), "arm_width_m", arm_width_m,
          fmt::format("less than the inner radius, {:g}", inner_radius_m()));
  require(arm_half_length_m > 0.5 * arm_width_m && arm_half_length_m <= outer_radius_m(),
          "arm_half_length_m", arm_half_length_m,
          fmt::format("more than half of arm_width_m and at most the outer radius, {:g}",
                      outer_radius_m()));
  require(board_size_m >= outer_diameter_m, "board_size_m", board_size_m,
          fmt::format("at least the outer diameter, {}", outer_diameter_m));
  return violations;
}

LandingPattern Scaled(const LandingPattern& pattern, double factor) {
  return {.outer_diameter_m = factor * pattern.outer_diameter_m,
          .ring_width_m = factor * pattern.ring_width_m,
          .arm_width_m = factor * pattern.arm_width_m,
          .arm_half_length_m = factor * pattern.arm_half_length_m,
          .board_size_m = factor * pattern.board_size_m};
}

TargetShape ShapeOf(const LandingPattern& pattern) {
  constexpr double kSightPx = 10;  // diameter of a ring that nearly all images show
  return {pattern.outer_diameter_m,
          pattern.board_size_m,
          pattern.outer_diameter_m / kSightPx,
          {CircleLine(pattern.outer_radius_m()), CircleLine(pattern.inner_radius_m()),
           ClosedLine(CornersOfCross(pattern))}};
}

TargetPrint PrintOf(const LandingPattern& pattern) {
  const double width = pattern.arm_width_m;
  const double radius = pattern.outer_radius_m();
  // The corners of an arm end in the ring.
  const double longest = std::sqrt(radius * radius - 0.25 * width * width);
  const double length = 2 * std::min(pattern.arm_half_length_m, longest);
  TargetPrint print;
  print.board_size_m = pattern.board_size_m;
  print.board_heading = std::numbers::pi / 4;
  print.shapes = {{PrintRing{{0, 0}, radius, pattern.inner_radius_m()}},
                  {Rectangle({0, 0}, {width, length})},
                  {Rectangle({0, 0}, {length, width})}};
  print.dimensions = {fmt::format("ring: outer diameter {:g} mm, width {:g} mm",
                                  1000 * pattern.outer_diameter_m, 1000 * pattern.ring_width_m),
                      fmt::format("cross: arms {:g} mm wide, {:g} mm from the centre to their ends",
                                  1000 * width, 1000 * pattern.arm_half_length_m),
                      fmt::format("board: {0:g} x {0:g} mm, white", 1000 * pattern.board_size_m)};
  print.can_be_checked = true;
  return print;
}

}  // namespace kestrel
