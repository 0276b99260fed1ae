// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/alignment/print_outline.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kestrel {
namespace {

// Places around the two circles; the outer one has them nearer together, and none is left out.
constexpr int kOuterPlaces = 56;
constexpr int kInnerPlaces = 40;
// Arm widths: places are that far from an arm's axis and end, and twice as far from the middle, as
// blur and a print that is not exact reach.
constexpr double kClear = 0.8;

}  // namespace

PrintOutline::PrintOutline(const LandingPattern& pattern) {
  AddCircle(pattern, pattern.outer_radius_m(), 1, kOuterPlaces, 0);
  AddCircle(pattern, pattern.inner_radius_m(), -1, kInnerPlaces, kClear * pattern.arm_width_m);
  ring_places_ = places_.size();
  AddArms(pattern);
}

// 'sign': 1 when the white lies outside of the circle, -1 when inside. Points nearer than
// 'arm_clearance' (m) to the axis of an arm are left out, because the outline may be broken there.
void PrintOutline::AddCircle(const LandingPattern& pattern, double radius, double sign, int count,
                             double arm_clearance) {
  for (int i = 0; i < count; ++i) {
    const double angle = (i + 0.5) * 2 * std::numbers::pi / count;
    const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
    const Eigen::Vector2d point = radius * direction;
    if (std::min(std::abs(point.x()), std::abs(point.y())) < arm_clearance) continue;
    const int quarter = static_cast<int>(std::floor(angle / (std::numbers::pi / 2) + 0.5)) % kArms;
    places_.push_back({point, sign * direction, kArms + quarter, sign > 0 ? 1 : 0,
                       pattern.ring_width_m, sign / radius});
  }
}

void PrintOutline::AddArms(const LandingPattern& pattern) {
  const double half_width = 0.5 * pattern.arm_width_m;
  const double first = 2 * kClear * pattern.arm_width_m;
  const double last =
      std::min(pattern.arm_half_length_m, pattern.inner_radius_m()) - kClear * pattern.arm_width_m;
  constexpr int kPerSide = 6;
  for (int arm = 0; arm < kArms; ++arm) {
    const double angle = arm * std::numbers::pi / 2;
    const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
    const Eigen::Vector2d across(-along.y(), along.x());
    for (const double side : {1.0, -1.0}) {
      for (int i = 0; i < kPerSide; ++i) {
        const double reach = first + (last - first) * i / (kPerSide - 1);
        places_.push_back({reach * along + side * half_width * across, side * across, arm,
                           side > 0 ? 1 : 0, pattern.arm_width_m, 0});
      }
    }
  }
}

}  // namespace kestrel
