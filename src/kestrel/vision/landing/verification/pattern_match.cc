// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/verification/pattern_match.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

#include "kestrel/core/base/robust_statistics.h"
#include "kestrel/core/image/gray_sampling.h"
#include "kestrel/vision/landing/image_properties.h"
#include "kestrel/vision/landing/print_places.h"

namespace kestrel {
namespace {

constexpr int kQuarters = LandingPattern::kArms;
constexpr int kRingPlaces = 48;
constexpr std::size_t kFewestOfRing = kRingPlaces / 6;  // of which a contrast is known
constexpr int kArmPlaces = 10;                          // along half an arm
static_assert(kQuarters * kArmPlaces <= kRingPlaces);   // they may stand for the ring
constexpr std::size_t kMaxPlaces = 400;
// A contrast counts when it has at least this share of the print's contrast in its quarter.
constexpr double kShare = 0.35;
// Directions of the places in a quadrant, in degrees from the arm before it, and their radii, in
// inner radii of the ring.
constexpr std::array<double, 7> kQuadrantAngles{27, 33, 39, 45, 51, 57, 63};
constexpr std::array<double, 3> kQuadrantRadii{0.45, 0.6, 0.75};
// Places, in widths of their stroke: of white outside of the ring and beside an arm, from the
// middle; the first place along an arm is further out, and the last one is before its end.
constexpr double kOutside = 0.8;
constexpr double kBesideArmFrom = 1.15;
constexpr double kBeforeEnd = 0.3;
constexpr double kBeyondHub_m = 0.02;
constexpr double kViewMargin = 1.02;  // factor of the view beyond the outermost places
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

// Radius of the middle of the ring's stroke, m.
double MiddleOfRing(const LandingPattern& pattern) {
  return 0.5 * (pattern.outer_radius_m() + pattern.inner_radius_m());
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
  const double margin = 0.5 * pattern.board_size_m - pattern.outer_radius_m();
  const double outside = pattern.outer_radius_m() +
                         std::min(kOutside * pattern.ring_width_m, PrintPlaces::kMargin * margin);
  extent_m_ = outside * kViewMargin;
  AddRing(pattern, outside);
  for (int quarter = 0; quarter < kQuarters; ++quarter) {
    AddArm(pattern, quarter);
    AddQuadrant(pattern, quarter);
  }
}

void PatternMatcher::AddRing(const LandingPattern& pattern, double outside_m) {
  const double inner = pattern.inner_radius_m();
  const auto angle = [](int i) { return (i + 0.5) * 2 * std::numbers::pi / kRingPlaces; };
  for (int i = 0; i < kRingPlaces; ++i) AddPolar(PrintPlaces::kInside * inner, angle(i));
  for (int i = 0; i < kRingPlaces; ++i) {
    const int quarter = static_cast<int>(std::floor(angle(i) / (std::numbers::pi / 2) + 0.5));
    const std::size_t dark = AddPolar(MiddleOfRing(pattern), angle(i));
    const std::size_t bright = AddPolar(outside_m, angle(i));
    ring_.push_back({quarter % kQuarters, {dark, dark}, {bright, bright}});
  }
}

void PatternMatcher::AddArm(const LandingPattern& pattern, int quarter) {
  const double reach = std::min(pattern.arm_half_length_m, pattern.inner_radius_m()) -
                       kBeforeEnd * pattern.arm_width_m;
  const double side = kBesideArmFrom * pattern.arm_width_m;
  for (int i = 0; i < kArmPlaces; ++i) {
    const double along = side + kBeyondHub_m + (reach - side - kBeyondHub_m) * i / (kArmPlaces - 1);
    const std::size_t dark = AddBeside(quarter, along, 0);
    arms_.push_back({quarter,
                     {dark, dark},
                     {AddBeside(quarter, along, side), AddBeside(quarter, along, -side)}});
  }
}

// From half a quadrant before the arm to half a quadrant behind it.
void PatternMatcher::AddQuadrant(const LandingPattern& pattern, int quarter) {
  const double inner = pattern.inner_radius_m();
  std::array<std::size_t, kQuadrantRadii.size()> on_arm;
  for (std::size_t k = 0; k < on_arm.size(); ++k) {
    on_arm[k] = AddBeside(quarter, kQuadrantRadii[k] * inner, 0);
  }
  for (const double degrees : kQuadrantAngles) {
    const double angle = (quarter + degrees / 90) * std::numbers::pi / 2;
    const std::size_t on_ring = AddPolar(MiddleOfRing(pattern), angle);
    for (std::size_t k = 0; k < on_arm.size(); ++k) {
      const std::size_t bright = AddPolar(kQuadrantRadii[k] * inner, angle);
      quadrants_.push_back(
          {(quarter + (degrees > 45 ? 1 : 0)) % kQuarters, {on_ring, on_arm[k]}, {bright, bright}});
    }
  }
}

std::size_t PatternMatcher::AddPolar(double radius_m, double angle) {
  return AddPlace(radius_m * std::cos(angle), radius_m * std::sin(angle));
}

// In the frame of an arm: distance along it and across it, m.
std::size_t PatternMatcher::AddBeside(int quarter, double along_m, double across_m) {
  const double angle = quarter * std::numbers::pi / 2;
  return AddPlace(along_m * std::cos(angle) - across_m * std::sin(angle),
                  along_m * std::sin(angle) + across_m * std::cos(angle));
}

std::size_t PatternMatcher::AddPlace(double x_m, double y_m) {
  x_m_.push_back(static_cast<float>(x_m));
  y_m_.push_back(static_cast<float>(y_m));
  return x_m_.size() - 1;
}

// A seen contrast: white minus black on the darker side and on the brighter side (gray values), and
// the former divided by the white.
struct PatternMatcher::Seen {
  static constexpr float kUnseen = -1e9f;

  float difference = kUnseen;
  float brighter_difference = kUnseen;
  float ratio = kUnseen;
  bool known() const { return difference != kUnseen; }
};

// Counts of the contrasts of a part.
struct PatternMatcher::Tally {
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

// Values at the places that are in view, at most kMost.
template <std::size_t kMost>
struct PatternMatcher::Values {
  void Add(float value) { all[count++] = value; }
  void Clear() { count = 0; }
  double Median() { return count == 0 ? 0 : MedianInPlace(std::span(all).first(count)); }

  std::array<float, kMost> all;
  std::size_t count = 0;
};

double PatternMatcher::RingContrast(const cv::Mat& image, const PatternView& view) const {
  std::array<float, 3 * kRingPlaces> gray;
  view.Sample(image, x_m_.data(), y_m_.data(), gray.size(), gray.data());
  Values<kRingPlaces> outside, inside;
  for (std::size_t i = 0; i < kRingPlaces; ++i) {
    const float within = gray[i];
    const float dark = gray[ring_[i].dark[0]];
    const float bright = gray[ring_[i].bright[0]];
    if (dark < 0 || bright < 0) continue;
    outside.Add(bright - dark);
    if (within >= 0) inside.Add(within - dark);
  }
  if (outside.count < kFewestOfRing) return 0;
  const double contrast = outside.Median();
  if (inside.count < kFewestOfRing) return contrast;
  // Inside, arms and white alternate: a quarter of the directions must show white.
  const float white =
      RankedInPlace(std::span(inside.all).first(inside.count), inside.count - inside.count / 4);
  return white < PrintPlaces::kLeastInside * contrast ? 0 : contrast;
}

// The gray values of the image at the places of the print, and the looks of its parts from them.
class PatternMatcher::Comparison {
 public:
  Comparison(const PatternMatcher& print, const cv::Mat& image, const PatternView& view)
      : print_(print) {
    view.Sample(image, print.x_m_.data(), print.y_m_.data(), print.x_m_.size(), gray_.data());
    MeasureRing();
    if (differences_.count < kFewestOfRing) MeasureArms();
    contrast_ = differences_.Median();
  }

  // Contrast of the print, gray values.
  double contrast() const { return contrast_; }

  void Match(PatternMatch* match) {
    SetBounds();
    SetHighlights();
    for (std::size_t i = 0; i < print_.ring_.size(); ++i) {
      Count(print_.ring_[i], of_ring_[i], &ring_);
    }
    for (const Contrast& contrast : print_.arms_) CountArm(contrast);
    for (const Contrast& contrast : print_.quadrants_) {
      Count(contrast, LookAt(contrast), &quadrant_);
    }
    int seen = 0, all = 0;
    for (int q = 0; q < kQuarters; ++q) {
      match->shares.arm[q] = arm_[q].Share();
      match->shares.quadrant[q] = quadrant_[q].Share();
      match->shares.ring[q] = ring_[q].Share();
      for (const Tally& tally : {arm_[q], quadrant_[q], ring_[q]}) {
        seen += tally.seen;
        all += tally.all;
      }
    }
    match->seen = static_cast<double>(seen) / all;
  }

 private:
  using Tallies = std::array<Tally, kQuarters>;

  // Returns the darker and the brighter gray value of two places, which may be equal.
  std::pair<float, float> Sample(const std::array<std::size_t, 2>& places) const {
    const float first = gray_[places[0]];
    const float second = gray_[places[1]];
    if (first < 0) return {second, second};
    if (second < 0) return {first, first};
    return std::minmax({first, second});
  }
  float DarkOf(const Contrast& contrast) const { return Sample(contrast.dark).first; }
  float BrightOf(const Contrast& contrast) const { return Sample(contrast.bright).first; }

  Seen LookAt(const Contrast& contrast) const {
    const float dark = DarkOf(contrast);
    const auto [bright, brighter] = Sample(contrast.bright);
    if (dark < 0 || bright < 0) return {};
    return {bright - dark, brighter - dark, (bright - dark) / std::max(bright, 1.0f)};
  }

  void MeasureRing() {
    for (std::size_t i = 0; i < print_.ring_.size(); ++i) {
      const Contrast& contrast = print_.ring_[i];
      of_ring_[i] = LookAt(contrast);
      if (!of_ring_[i].known()) continue;
      differences_.Add(of_ring_[i].difference);
      ratios_.Add(of_ring_[i].ratio);
      ink_.Add(DarkOf(contrast));
      board_[contrast.quarter].Add(BrightOf(contrast));
      of_quarter_[contrast.quarter].Add(of_ring_[i].difference);
    }
  }

  // Where the ring is out of view, the arms serve instead.
  void MeasureArms() {
    differences_.Clear();
    ratios_.Clear();
    ink_.Clear();
    for (const Contrast& contrast : print_.arms_) {
      const Seen seen = LookAt(contrast);
      if (!seen.known()) continue;
      differences_.Add(seen.difference);
      ratios_.Add(seen.ratio);
    }
  }

  // The contrast of the print in each quarter, which shadow and haze may change, is that of the
  // ring there, but at least a third of that of the whole ring. In a quarter with light and shadow,
  // black is in the same proportion to the white beside it. Along an arm at the edge of a shadow,
  // one side is in the light.
  void SetBounds() {
    least_in_light_ = kShareInLight * contrast_;
    least_ratio_ = kRatioShare * ratios_.Median();
    least_in_shadow_ = std::max(kLeastInShadow, kShareInShadow * contrast_);
    for (int q = 0; q < kQuarters; ++q) {
      const double local = of_quarter_[q].count == 0 ? contrast_ : of_quarter_[q].Median();
      least_[q] = kShare * std::clamp(local, contrast_ / 3, contrast_);
    }
  }

  void SetHighlights() {
    Values<kMaxPlaces> white;
    for (const Contrast& contrast : print_.quadrants_) {
      const float bright = BrightOf(contrast);
      if (bright >= 0) white.Add(bright);
    }
    const double white_inside = white.Median();
    middle_ = 0.5 * (ink_.Median() + white_inside);
    for (int q = 0; q < kQuarters; ++q) {
      highlight_[q] = HighlightGray(std::max(white_inside, board_[q].Median()), contrast_);
    }
  }

  bool Agrees(const Seen& value, int quarter) const {
    return value.difference >= least_[quarter] ||
           (value.difference >= least_in_shadow_ &&
            (value.ratio >= least_ratio_ || value.brighter_difference >= least_in_light_));
  }

  // An arm is hidden, for instance by a landing leg, where both the arm and its side are nearer to
  // black than to the white inside of the ring. A missing arm would leave that white.
  bool HidesArm(const Contrast& contrast) const {
    return ink_.count > 0 && DarkOf(contrast) < middle_ && BrightOf(contrast) < middle_;
  }

  void Count(const Contrast& contrast, const Seen& value, Tallies* tallies) const {
    Tally& tally = (*tallies)[contrast.quarter];
    ++tally.all;
    if (!value.known()) return;
    ++tally.seen;
    tally.agreed += Agrees(value, contrast.quarter);
  }

  // Highlights hide arms too.
  void CountArm(const Contrast& contrast) {
    const Seen value = LookAt(contrast);
    const int q = contrast.quarter;
    const bool hidden = value.known() && !Agrees(value, q) && HidesArm(contrast);
    Count(contrast, hidden ? Seen{} : value, &arm_);
    arm_[q].in_highlight += value.known() && DarkOf(contrast) >= highlight_[q];
  }

  const PatternMatcher& print_;
  std::array<float, kMaxPlaces> gray_;
  std::array<Seen, kRingPlaces> of_ring_;
  Values<kRingPlaces> differences_, ratios_, ink_;
  std::array<Values<kRingPlaces>, kQuarters> of_quarter_, board_;  // difference, white outside
  double contrast_;
  // Bounds, see kShare and kRatioShare; the first by quarter.
  std::array<double, kQuarters> least_;
  double least_in_light_, least_ratio_, least_in_shadow_;
  double middle_;                            // between ink and white, gray value
  std::array<double, kQuarters> highlight_;  // least gray value of a highlight, by quarter
  Tallies arm_, quadrant_, ring_;
};

PatternMatch PatternMatcher::Match(const cv::Mat& image, const PatternView& view) const {
  PatternMatch match;
  Comparison comparison(*this, image, view);
  match.contrast = comparison.contrast();
  if (match.contrast >= GrayContrast::kLeast) comparison.Match(&match);
  return match;
}

}  // namespace kestrel
