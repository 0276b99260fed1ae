// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/score/ring_probe.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "kestrel/core/base/robust_statistics.h"
#include "kestrel/vision/landing/print_places.h"

namespace kestrel {
namespace {

constexpr double kOutside = 0.8;      // ring widths from the ring's outer edge
constexpr double kViewMargin = 1.02;  // factor of the view beyond the outermost places

}  // namespace

RingProbe::RingProbe(const LandingPattern& pattern) {
  const double margin = 0.5 * pattern.board_size_m - pattern.outer_radius_m();
  const double outside = pattern.outer_radius_m() +
                         std::min(kOutside * pattern.ring_width_m, PrintPlaces::kMargin * margin);
  extent_m_ = outside * kViewMargin;
  const std::array<double, 3> radii{PrintPlaces::kInside * pattern.inner_radius_m(),
                                    0.5 * (pattern.outer_radius_m() + pattern.inner_radius_m()),
                                    outside};
  for (std::size_t i = 0; i < x_m_.size(); ++i) {
    const double angle = (static_cast<double>(i % kPlaces) + 0.5) * 2 * std::numbers::pi / kPlaces;
    x_m_[i] = static_cast<float>(radii[i / kPlaces] * std::cos(angle));
    y_m_[i] = static_cast<float>(radii[i / kPlaces] * std::sin(angle));
  }
}

double RingProbe::Contrast(const cv::Mat& image, const PatternView& view) const {
  constexpr std::size_t kFewest = kPlaces / 6;  // places with a known contrast
  std::array<float, 3 * kPlaces> gray;
  view.Sample(image, x_m_.data(), y_m_.data(), gray.size(), gray.data());
  std::array<float, kPlaces> outside, inside;
  std::size_t outside_count = 0, inside_count = 0;
  for (std::size_t i = 0; i < kPlaces; ++i) {
    const float within = gray[i], dark = gray[i + kPlaces], bright = gray[i + 2 * kPlaces];
    if (dark < 0 || bright < 0) continue;
    outside[outside_count++] = bright - dark;
    if (within >= 0) inside[inside_count++] = within - dark;
  }
  if (outside_count < kFewest) return 0;
  const double contrast = MedianInPlace(std::span(outside).first(outside_count));
  if (inside_count < kFewest) return contrast;
  // Inside, arms and white alternate: a quarter of the directions must show white.
  const float white =
      RankedInPlace(std::span(inside).first(inside_count), inside_count - inside_count / 4);
  return white < PrintPlaces::kLeastInside * contrast ? 0 : contrast;
}

}  // namespace kestrel
