// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/pattern_match.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

#include "kestrel/core/base/robust_statistics.h"
#include "kestrel/core/image/gray_sampling.h"

namespace kestrel {
namespace {

constexpr int kRingPlaces = 48;
constexpr std::size_t kMaxPlaces = 400;
// A contrast counts when it has at least this share of the print's contrast in its quarter.
constexpr double kShare = 0.35;
// Directions of the places in a quadrant, in degrees from the arm before it, and their radii, in
// inner radii of the ring.
constexpr int kQuadrantTurns = 7;
constexpr std::array<double, kQuadrantTurns> kQuadrantAngles{27, 33, 39, 45, 51, 57, 63};
constexpr std::array<double, 3> kQuadrantRadii{0.45, 0.6, 0.75};
constexpr float kUnseen = -1e9f;
constexpr double kInsideRadius = 0.65;  // radius of the places inside of the ring, inner radii
constexpr double kLeastInside = 0.2;    // least contrast there, share of that of the ring
// A contrast in a shadow counts when its share of the brightness is at least kRatioShare times the
// print's, or when its brighter side has at least kShareInLight of the print's contrast. It must
// also exceed noise: kLeastInShadow gray values and kShareInShadow of the print's contrast.
constexpr double kRatioShare = 0.6;
constexpr double kShareInLight = 0.7;
constexpr double kLeastInShadow = 4;
constexpr double kShareInShadow = 0.1;
// Least brightness of a highlight above the white of the board, shares of the print's contrast: in
// general, and for one that saturates the image.
constexpr double kHighlight = 0.4;
constexpr double kSaturatedHighlight = 0.15;

// A seen contrast: white minus black on the darker side and on the brighter side (gray values), and
// the former divided by the white.
struct Seen {
  float difference;
  float brighter_difference;
  float ratio;
  bool known() const { return difference != kUnseen; }
};
constexpr Seen kNotSeen{kUnseen, kUnseen, kUnseen};

struct Tally {
  static constexpr int kSeenOf = 5;  // one in kSeenOf must be in view
  int agreed = 0;
  int in_highlight = 0;
  int seen = 0;
  int all = 0;

  // Negative where too little is in view, and where half or more lies in a highlight.
  double Share() const {
    if (kSeenOf * seen < all || (in_highlight > 0 && 2 * in_highlight >= seen)) return -1;
    return static_cast<double>(agreed) / std::max(seen, 1);
  }
};

template <typename Values>
double Median(Values* values, std::size_t count) {
  if (count == 0) return 0;
  return MedianInPlace(std::span(*values).first(count));
}

// Returns the least gray value that no part of the print reaches beside the given white of the
// board; infinity where no white is in view.
double HighlightGray(double white, double contrast) {
  if (white <= 0) return std::numeric_limits<double>::infinity();
  const double gray = white + kHighlight * contrast;
  const bool saturates = white + kSaturatedHighlight * contrast < kSaturatedGray;
  return saturates ? std::min<double>(gray, kSaturatedGray) : gray;
}

// Statistics of the shares of the quarters that are in view.
struct KnownShares {
  explicit KnownShares(const std::array<double, 4>& shares) {
    for (const double share : shares) {
      if (share < 0) continue;
      worst = std::min(worst, share);
      sum += share;
      ++count;
    }
  }
  double Mean() const { return count == 0 ? 1 : sum / count; }  // 1 when none is in view

  double worst = 1;
  double sum = 0;
  int count = 0;
};

}  // namespace

PartShares::Means PartShares::MeansInView() const {
  const KnownShares arms(arm);
  const KnownShares rings(ring);
  Means means{0, 0, KnownShares(quadrant).Mean(), rings.Mean()};
  if (arms.count > 0) {
    means.worst_arm = arms.worst;
    means.arms = arms.Mean();
  }
  if (rings.count > 1) means.ring = (rings.sum - rings.worst) / (rings.count - 1);
  return means;
}

double PatternMatch::Agreement() const {
  const PartShares::Means means = shares.MeansInView();
  return std::min({means.arms, means.quadrants, means.ring});
}

PatternMatcher::PatternMatcher(const LandingPattern& pattern) {
  const double outer = pattern.outer_radius_m();
  const double inner = pattern.inner_radius_m();
  const double middle = 0.5 * (outer + inner);
  const double margin = 0.5 * pattern.board_size_m - outer;
  const double outside = outer + std::min(0.8 * pattern.ring_width_m, 0.6 * margin);
  extent_m_ = outside * 1.02;
  const auto at = [this](double radius, double angle) {
    return AddPlace(radius * std::cos(angle), radius * std::sin(angle));
  };
  // In the frame of an arm: distance along it and across it, m.
  const auto beside = [this](int quarter, double along, double across) {
    const double angle = quarter * std::numbers::pi / 2;
    return AddPlace(along * std::cos(angle) - across * std::sin(angle),
                    along * std::sin(angle) + across * std::cos(angle));
  };
  const auto ring_angle = [](int i) { return (i + 0.5) * 2 * std::numbers::pi / kRingPlaces; };
  for (int i = 0; i < kRingPlaces; ++i) at(kInsideRadius * inner, ring_angle(i));
  for (int i = 0; i < kRingPlaces; ++i) {
    const int quarter = static_cast<int>(std::floor(ring_angle(i) / (std::numbers::pi / 2) + 0.5));
    const std::size_t dark = at(middle, ring_angle(i));
    const std::size_t bright = at(outside, ring_angle(i));
    ring_.push_back({quarter % 4, {dark, dark}, {bright, bright}});
  }
  const double reach = std::min(pattern.arm_half_length_m, inner) - 0.3 * pattern.arm_width_m;
  const double side = 1.15 * pattern.arm_width_m;
  for (int quarter = 0; quarter < 4; ++quarter) {
    for (int i = 0; i < 10; ++i) {
      const double along = side + 0.02 + (reach - side - 0.02) * i / 9;
      const std::size_t dark = beside(quarter, along, 0);
      arms_.push_back(
          {quarter, {dark, dark}, {beside(quarter, along, side), beside(quarter, along, -side)}});
    }
    std::array<std::size_t, kQuadrantRadii.size()> on_arm;
    for (std::size_t k = 0; k < on_arm.size(); ++k) {
      on_arm[k] = beside(quarter, kQuadrantRadii[k] * inner, 0);
    }
    // From half a quadrant before the arm to half a quadrant behind it.
    for (int i = 0; i < kQuadrantTurns; ++i) {
      const double angle = (quarter + kQuadrantAngles[i] / 90) * std::numbers::pi / 2;
      const std::size_t on_ring = at(middle, angle);
      for (std::size_t k = 0; k < on_arm.size(); ++k) {
        const std::size_t bright = at(kQuadrantRadii[k] * inner, angle);
        quadrants_.push_back({(quarter + (kQuadrantAngles[i] > 45 ? 1 : 0)) % 4,
                              {on_ring, on_arm[k]},
                              {bright, bright}});
      }
    }
  }
}

std::size_t PatternMatcher::AddPlace(double x_m, double y_m) {
  x_m_.push_back(static_cast<float>(x_m));
  y_m_.push_back(static_cast<float>(y_m));
  return x_m_.size() - 1;
}

double PatternMatcher::RingContrast(const cv::Mat& image, const PatternView& view) const {
  std::array<float, 3 * kRingPlaces> gray;
  view.Sample(image, x_m_.data(), y_m_.data(), gray.size(), gray.data());
  std::array<float, kRingPlaces> outside, inside;
  std::size_t count = 0, inside_count = 0;
  for (std::size_t i = 0; i < kRingPlaces; ++i) {
    const float within = gray[i];
    const float dark = gray[ring_[i].dark[0]];
    const float bright = gray[ring_[i].bright[0]];
    if (dark < 0 || bright < 0) continue;
    outside[count++] = bright - dark;
    if (within >= 0) inside[inside_count++] = within - dark;
  }
  if (count < kRingPlaces / 6) return 0;
  const double contrast = Median(&outside, count);
  // Inside, arms and white alternate: a quarter of the directions must show white.
  const std::size_t upper = inside_count - inside_count / 4;
  if (inside_count >= kRingPlaces / 6) {
    const float white = RankedInPlace(std::span(inside).first(inside_count), upper);
    if (white < kLeastInside * contrast) return 0;
  }
  return contrast;
}

PatternMatch PatternMatcher::Match(const cv::Mat& image, const PatternView& view) const {
  PatternMatch match;
  std::array<Tally, 4> arm, quadrant, ring;
  std::array<float, kMaxPlaces> gray;
  view.Sample(image, x_m_.data(), y_m_.data(), x_m_.size(), gray.data());
  // Returns the darker and the brighter gray value of two places, which may be equal.
  const auto sample = [&](const std::array<std::size_t, 2>& places) -> std::pair<float, float> {
    const float first = gray[places[0]];
    const float second = gray[places[1]];
    if (first < 0) return {second, second};
    if (second < 0) return {first, first};
    return std::minmax({first, second});
  };
  const auto look_at = [&](const Contrast& contrast) -> Seen {
    const float dark = sample(contrast.dark).first;
    const auto [bright, brighter] = sample(contrast.bright);
    if (dark < 0 || bright < 0) return kNotSeen;
    return {bright - dark, brighter - dark, (bright - dark) / std::max(bright, 1.0f)};
  };

  // The contrast of the print in each quarter, which shadow and haze may change, is that of the
  // ring there, but at least a third of that of the whole ring. Where the ring is out of view, the
  // arms serve instead.
  std::array<Seen, kRingPlaces> of_ring;
  std::array<float, kRingPlaces> known, known_ratio, ink;
  std::size_t count = 0, ink_count = 0;
  std::array<std::array<float, kRingPlaces>, 4> of_quarter, board;
  std::array<std::size_t, 4> quarter_count{};
  for (std::size_t i = 0; i < ring_.size(); ++i) {
    of_ring[i] = look_at(ring_[i]);
    if (!of_ring[i].known()) continue;
    known[count] = of_ring[i].difference;
    known_ratio[count++] = of_ring[i].ratio;
    ink[ink_count++] = sample(ring_[i].dark).first;
    const int q = ring_[i].quarter;
    board[q][quarter_count[q]] = sample(ring_[i].bright).first;
    of_quarter[q][quarter_count[q]++] = of_ring[i].difference;
  }
  if (count < kRingPlaces / 6) {
    count = ink_count = 0;
    for (const Contrast& contrast : arms_) {
      if (count == known.size()) break;
      const Seen arm_contrast = look_at(contrast);
      if (!arm_contrast.known()) continue;
      known[count] = arm_contrast.difference;
      known_ratio[count++] = arm_contrast.ratio;
    }
  }
  match.contrast = Median(&known, count);
  if (match.contrast < 2) return match;
  // In a quarter with light and shadow, black is in the same proportion to the white beside it.
  // Along an arm at the edge of a shadow, one side is in the light.
  const double least_in_light = kShareInLight * match.contrast;
  const double least_ratio = kRatioShare * Median(&known_ratio, count);
  const double least_in_shadow = std::max(kLeastInShadow, kShareInShadow * match.contrast);
  std::array<double, 4> least;
  for (int q = 0; q < 4; ++q) {
    const double local =
        quarter_count[q] == 0 ? match.contrast : Median(&of_quarter[q], quarter_count[q]);
    least[q] = kShare * std::clamp(local, match.contrast / 3, match.contrast);
  }

  const auto agrees = [&](const Seen& value, int quarter) {
    return value.difference >= least[quarter] ||
           (value.difference >= least_in_shadow &&
            (value.ratio >= least_ratio || value.brighter_difference >= least_in_light));
  };
  // An arm is hidden, for instance by a landing leg, where both the arm and its side are nearer to
  // black than to the white inside of the ring. A missing arm would leave that white.
  std::array<float, kMaxPlaces> white;
  std::size_t white_count = 0;
  for (const Contrast& contrast : quadrants_) {
    const float bright = sample(contrast.bright).first;
    if (bright >= 0) white[white_count++] = bright;
  }
  const double white_inside = Median(&white, white_count);
  const double middle = 0.5 * (Median(&ink, ink_count) + white_inside);
  const auto hides_arm = [&](const Contrast& contrast) {
    return ink_count > 0 && sample(contrast.dark).first < middle &&
           sample(contrast.bright).first < middle;
  };
  // Highlights hide arms too.
  std::array<double, 4> highlight;
  for (int q = 0; q < 4; ++q) {
    const double white_outside = Median(&board[q], quarter_count[q]);
    highlight[q] = HighlightGray(std::max(white_inside, white_outside), match.contrast);
  }
  int seen = 0, all = 0;
  const auto count_in = [&](const Contrast& contrast, const Seen& value,
                            std::array<Tally, 4>* tallies) {
    Tally& tally = (*tallies)[contrast.quarter];
    ++tally.all;
    ++all;
    if (!value.known()) return;
    ++tally.seen;
    ++seen;
    tally.agreed += agrees(value, contrast.quarter);
  };
  for (std::size_t i = 0; i < ring_.size(); ++i) count_in(ring_[i], of_ring[i], &ring);
  for (const Contrast& contrast : arms_) {
    const Seen value = look_at(contrast);
    const bool hidden = value.known() && !agrees(value, contrast.quarter) && hides_arm(contrast);
    count_in(contrast, hidden ? kNotSeen : value, &arm);
    arm[contrast.quarter].in_highlight +=
        value.known() && sample(contrast.dark).first >= highlight[contrast.quarter];
  }
  for (const Contrast& contrast : quadrants_) count_in(contrast, look_at(contrast), &quadrant);
  for (int q = 0; q < 4; ++q) {
    match.shares.arm[q] = arm[q].Share();
    match.shares.quadrant[q] = quadrant[q].Share();
    match.shares.ring[q] = ring[q].Share();
  }
  match.seen = static_cast<double>(seen) / all;
  return match;
}

}  // namespace kestrel
