// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/verification/cross.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace kestrel {
namespace {

constexpr int kRingDirections = 96;               // around the ring
constexpr int kPerQuarter = kRingDirections / 4;  // over a right angle
constexpr int kBeside = kPerQuarter * 28 / 90;  // from the middle of an arm to the white beside it
constexpr std::array<double, 5> kRadii{0.34, 0.46, 0.58, 0.7, 0.82};  // inner radii of the ring

using DirectionTable = std::array<Eigen::Vector2f, kRingDirections>;
const DirectionTable& Directions() {
  static const DirectionTable kTable = [] {
    DirectionTable table;
    for (int i = 0; i < kRingDirections; ++i) {
      const double angle = 2 * std::numbers::pi * i / kRingDirections;
      table[i] = Eigen::Vector2d(std::cos(angle), std::sin(angle)).cast<float>();
    }
    return table;
  }();
  return kTable;
}

}  // namespace

std::optional<ArmDirection> FindArms(const cv::Mat& image, const PatternView& view,
                                     const LandingPattern& pattern) {
  // For each direction modulo a right angle: how much darker it is than the image beside it, as the
  // mean over the half arms and radii in view.
  std::array<float, kPerQuarter> sum{};
  std::array<int, kPerQuarter> seen{};
  std::array<float, kRingDirections> x, y, gray;
  for (const double radius : kRadii) {
    const auto r = static_cast<float>(radius * pattern.inner_radius_m());
    for (int i = 0; i < kRingDirections; ++i) {
      x[i] = r * Directions()[i].x();
      y[i] = r * Directions()[i].y();
    }
    view.Sample(image, x.data(), y.data(), kRingDirections, gray.data());
    for (int i = 0; i < kRingDirections; ++i) {
      const float before = gray[(i + kRingDirections - kBeside) % kRingDirections];
      const float after = gray[(i + kBeside) % kRingDirections];
      if (gray[i] < 0 || (before < 0 && after < 0)) continue;
      // The darker side counts: the edge of a shadow is no arm.
      const float beside = before < 0 ? after : after < 0 ? before : std::min(before, after);
      sum[i % kPerQuarter] += beside - gray[i];
      ++seen[i % kPerQuarter];
    }
  }
  std::array<float, kPerQuarter> depth{};
  for (int i = 0; i < kPerQuarter; ++i) {
    if (seen[i] > 0) depth[i] = sum[i] / static_cast<float>(seen[i]);
  }
  const auto best = std::max_element(depth.begin(), depth.end());
  if (*best <= 0) return std::nullopt;
  const auto index = static_cast<int>(best - depth.begin());
  const double left = depth[(index + kPerQuarter - 1) % kPerQuarter];
  const double right = depth[(index + 1) % kPerQuarter];
  const double curvature = left - 2 * *best + right;
  const double shift = curvature < 0 ? 0.5 * (left - right) / curvature : 0;
  return ArmDirection{(index + shift) * 2 * std::numbers::pi / kRingDirections, *best};
}

}  // namespace kestrel
