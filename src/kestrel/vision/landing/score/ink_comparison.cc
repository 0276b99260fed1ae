// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/score/ink_comparison.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <optional>
#include <span>

#include "kestrel/core/base/robust_statistics.h"
#include "kestrel/core/image/gray_sampling.h"
#include "kestrel/vision/landing/image_properties.h"
#include "kestrel/vision/landing/score/gray_doubts.h"
#include "kestrel/vision/landing/score/ink_in_highlights.h"

namespace kestrel {
namespace {

constexpr int kSide = 46;  // places along a side of the square; a stroke is three places wide
constexpr double kOffAxis = 0.15;  // from the middle of a stroke, share of its width
// Margins along the edges of the print, as far as blur reaches; shares of a stroke's width.
constexpr double kBesideRing = 0.35;
constexpr double kBesideArm = 0.3;
constexpr double kArmReach = 0.88;   // share of the arm's half length, which varies between prints
constexpr double kArmStart = 0.6;    // arm widths from the middle
constexpr double kHub = 2;           // radius of the hub, arm widths
constexpr double kSpokeStart = 1.5;  // start of a line between the arms, arm widths from the middle
constexpr double kLineHalf = 0.22;   // half the width of such a line, arm widths
constexpr double kInSector = 0.9239;  // cosine of half a sector
constexpr double kBoardReach = 0.55;  // share of the white margin around the ring
// Places of another ring around it, shares of that margin: the first, and from one to the next.
constexpr double kFirstAround = 0.24, kStepAround = 0.12;
// And of another ring inside, shares of the inner radius.
constexpr double kFirstInside = 0.3, kStepInside = 0.09;
// Quantiles of the gray values around a direction: ink, white in its shadows, white in the light.
constexpr double kInk = 0.5, kDarkerWhite = 0.25, kLitWhite = 0.8;
// Darkness runs from 0 (white) to 1 (ink). A ramp is 0 up to 'from' and 1 beyond 'to'. kIsInk: dark
// as ink; kIsDark: too dark for white; kIsInkOnly: darker than any shadow makes white.
struct Ramp {
  float from, to;
  float operator()(float darkness) const {
    return std::clamp((darkness - from) / (to - from), 0.0f, 1.0f);
  }
};
constexpr Ramp kIsInk{0.2f, 0.6f}, kIsDark{0.35f, 0.85f}, kIsInkOnly{0.7f, 0.95f};
// A dark place is a stroke of another ring; noise alone reaches the lower end.
constexpr Ramp kIsStroke{0.3f, 0.8f};
constexpr Ramp kInAnyLight{-1, 1};        // from white in a highlight to ink
constexpr float kBeyondWhite = 0.15f;     // above lit white, share of the contrast
constexpr float kVeiled = 0.2f;           // above the darkest ink, share of the contrast
constexpr float kLeastOfContrast = 0.25;  // share of the whole print's contrast, in any direction
constexpr double kEnoughSeen = 0.25;      // least share of places in view by which a part is judged

using Histogram = std::array<std::uint16_t, 256>;

// Returns the gray value below which 'share' of a histogram lies; nothing for an empty one.
std::optional<float> Quantile(const Histogram& histogram, double share) {
  const int count = std::accumulate(histogram.begin(), histogram.end(), 0);
  if (count == 0) return std::nullopt;
  const int wanted = static_cast<int>(share * (count - 1)) + 1;
  int below = 0;
  for (std::size_t gray = 0; gray < histogram.size(); ++gray) {
    below += histogram[gray];
    if (below >= wanted) return static_cast<float>(gray);
  }
  return std::nullopt;
}

// Sorted values. Unknown values are negative and come first.
template <std::size_t kCount>
class KnownValues {
 public:
  explicit KnownValues(const std::array<double, kCount>& all) : values_(all) {
    std::sort(values_.begin(), values_.end());
    first_ = static_cast<std::size_t>(
        std::find_if(values_.begin(), values_.end(), [](double value) { return value >= 0; }) -
        values_.begin());
  }
  bool empty() const { return first_ == kCount; }
  // Each returns 0 where there are no known values, or too few.
  double Least() const { return empty() ? 0 : values_[first_]; }
  double Median() const { return empty() ? 0 : values_[(first_ + kCount) / 2]; }
  double FromTop(std::size_t rank) const { return std::max(0.0, values_[kCount - 1 - rank]); }
  // Mean without the largest value, unless it is the only one.
  double MeanButTop() const {
    const std::size_t last = std::max(kCount - 1, first_ + 1);
    const double sum = std::accumulate(values_.begin() + static_cast<std::ptrdiff_t>(first_),
                                       values_.begin() + static_cast<std::ptrdiff_t>(last), 0.0);
    return empty() ? 0 : sum / static_cast<double>(last - first_);
  }

 private:
  std::array<double, kCount> values_;
  std::size_t first_;
};

// Correlation of a series with the ink of the print (1 where a place has ink, else 0).
class InkCorrelation {
 public:
  void Add(double darkness, bool is_ink) {
    ++n_;
    ink_ += is_ink;
    sum_ += darkness;
    squares_ += darkness * darkness;
    if (is_ink) sum_ink_ += darkness;
  }
  double value() const {
    const double variances = (squares_ - sum_ * sum_ / n_) * (ink_ - ink_ * ink_ / n_);
    return variances > 1e-9 ? (sum_ink_ - sum_ * ink_ / n_) / std::sqrt(variances) : 0;
  }

 private:
  double n_ = 0, ink_ = 0, sum_ = 0, squares_ = 0, sum_ink_ = 0;
};

}  // namespace

// Gray levels by sector.
struct InkComparison::Levels {
  std::array<float, kSectors> white;      // level of white, in the shadows that are there
  std::array<float, kSectors> per_gray;   // 1 / (white - ink)
  std::array<float, kSectors> highlight;  // gray value from which on a highlight may hide ink
  float ink = 0;                          // gray value of ink in the least light
  float veiled = 0;                       // gray value from which on light lies on ink
  bool has_contrast = false;
};

// Darkness of the places, 0 white to 1 ink (not clamped).
struct InkComparison::Darkness {
  // Mean of a ramp over the places of a range that are in view; negative where these are too few.
  double Mean(const Range& range, const Ramp& ramp) const {
    double sum = 0;
    int seen = 0;
    for (std::size_t i = range.begin; i < range.end; ++i) {
      if (!is_seen[i]) continue;
      sum += ramp(value[i]);
      ++seen;
    }
    return seen > 0 && seen >= kEnoughSeen * static_cast<double>(range.size()) ? sum / seen : -1;
  }
  double Mean(std::span<const std::uint16_t> places, const Ramp& ramp) const {
    double sum = 0;
    int seen = 0;
    for (const std::uint16_t place : places) {
      if (!is_seen[place]) continue;
      sum += ramp(value[place]);
      ++seen;
    }
    return seen > 0 && seen >= kEnoughSeen * static_cast<double>(places.size()) ? sum / seen : -1;
  }

  std::array<float, kMaxPlaces> value;
  std::array<bool, kMaxPlaces> is_seen;
};

InkComparison::InkComparison(const LandingPattern& pattern) : pattern_(pattern) {
  const double margin = 0.5 * pattern.board_size_m - pattern.outer_radius_m();
  extent_m_ = pattern.outer_radius_m() + kBoardReach * margin;
  AddPlaces();
}

void InkComparison::AddPlace(double x_m, double y_m) {
  const double turn = std::atan2(y_m, x_m) / (2 * std::numbers::pi) + 1;
  x_m_.push_back(static_cast<float>(x_m));
  y_m_.push_back(static_cast<float>(y_m));
  sector_.push_back(static_cast<std::uint8_t>(std::lround(turn * kSectors) % kSectors));
}

void InkComparison::AddPlaces() {
  AddInk();
  AddWhite();
  print_end_ = x_m_.size();
  AddAround();
  for (int quadrant = 0; quadrant < kArms; ++quadrant) AddLines(quadrant);
}

// Two rows of places along each arm and around the ring.
void InkComparison::AddInk() {
  const double first = kArmStart * pattern_.arm_width_m;
  const double step = (kArmReach * pattern_.arm_half_length_m - first) / (kAlongArm - 1);
  for (int k = 0; k < kArms; ++k) {
    const std::size_t begin = x_m_.size();
    const double cos = k % 2 == 0 ? 1 - k : 0, sin = k % 2 == 0 ? 0 : 2 - k;
    for (int i = 0; i < kAlongArm; ++i) {
      for (const double side : {-kOffAxis, kOffAxis}) {
        const double along = first + i * step, across = side * pattern_.arm_width_m;
        AddPlace(along * cos - across * sin, along * sin + across * cos);
      }
    }
    arm_[k] = {begin, x_m_.size()};
  }
  const double middle = 0.5 * (pattern_.inner_radius_m() + pattern_.outer_radius_m());
  for (int s = 0; s < kSectors; ++s) {
    const std::size_t begin = x_m_.size();
    for (int i = 0; i < kAroundSector; ++i) {
      const double turn = s - 0.5 + (i + 0.5) / kAroundSector;
      const double angle = turn * 2 * std::numbers::pi / kSectors;
      for (const double side : {-kOffAxis, kOffAxis}) {
        const double radius = middle + side * pattern_.ring_width_m;
        AddPlace(radius * std::cos(angle), radius * std::sin(angle));
      }
    }
    ring_[s] = {begin, x_m_.size()};
  }
  ink_end_ = x_m_.size();
}

// Adds the places (x, y) of a regular grid for which 'holds' returns true.
template <typename Holds>
InkComparison::Range InkComparison::AddGrid(const Holds& holds) {
  const std::size_t begin = x_m_.size();
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) {
      const double x = (2.0 * column + 1 - kSide) / kSide * extent_m_;
      const double y = (2.0 * row + 1 - kSide) / kSide * extent_m_;
      if (x_m_.size() < kMaxPrintPlaces && holds(x, y)) AddPlace(x, y);
    }
  }
  return {begin, x_m_.size()};
}

void InkComparison::AddWhite() {
  const double arm = pattern_.arm_width_m;
  const double inside = pattern_.inner_radius_m() - kBesideRing * pattern_.ring_width_m;
  const double outside = pattern_.outer_radius_m() + kBesideRing * pattern_.ring_width_m;
  const auto is_in_quadrant = [&](int quadrant, double x, double y) {
    const bool right = quadrant == 0 || quadrant == 3, upper = quadrant < 2;
    return (x > 0) == right && (y > 0) == upper && std::hypot(x, y) < inside &&
           std::min(std::abs(x), std::abs(y)) > (0.5 + kBesideArm) * arm;
  };
  for (int k = 0; k < kArms; ++k) {
    hub_[k] = AddGrid([&](double x, double y) {
      return is_in_quadrant(k, x, y) && std::hypot(x, y) < kHub * arm;
    });
    const Range rest = AddGrid([&](double x, double y) {
      return is_in_quadrant(k, x, y) && std::hypot(x, y) >= kHub * arm;
    });
    quadrant_[k] = {hub_[k].begin, rest.end};
  }
  for (int s = 0; s < kSectors; ++s) {
    const double middle = s * 2 * std::numbers::pi / kSectors;
    bool is_odd = false;  // takes every second place
    board_[s] = AddGrid([&](double x, double y) {
      const double radius = std::hypot(x, y);
      const bool is_board =
          radius > outside && radius < extent_m_ && std::cos(std::atan2(y, x) - middle) > kInSector;
      return is_board && (is_odd = !is_odd);
    });
  }
}

// Adds rows of places from the ring outwards, one in each direction.
void InkComparison::AddAround() {
  const double margin = 0.5 * pattern_.board_size_m - pattern_.outer_radius_m();
  for (int i = 0; i < kAroundRows; ++i) {
    const double angle = (i + 0.5) * 2 * std::numbers::pi / kAroundRows;
    for (int k = 0; k < kPerRow; ++k) {
      const double radius = pattern_.outer_radius_m() + (kFirstAround + k * kStepAround) * margin;
      AddPlace(radius * std::cos(angle), radius * std::sin(angle));
    }
  }
}

// Collects, from the places between two arms, those on lines along which another spoke may lie, and
// on arcs of another ring.
void InkComparison::AddLines(int quadrant) {
  const double arm = pattern_.arm_width_m;
  for (int i = 0; i < kLines; ++i) {
    const double angle = (quadrant + 0.3 + 0.1 * i) * 0.5 * std::numbers::pi;
    for (std::size_t place = quadrant_[quadrant].begin; place < quadrant_[quadrant].end; ++place) {
      const double x = x_m_[place], y = y_m_[place];
      if (std::abs(std::cos(angle) * y - std::sin(angle) * x) < kLineHalf * arm &&
          std::hypot(x, y) > kSpokeStart * arm) {
        line_[quadrant][i].push_back(static_cast<std::uint16_t>(place));
      }
    }
  }
  for (int i = 0; i < kArcs; ++i) {
    const double radius = (kFirstInside + i * kStepInside) * pattern_.inner_radius_m();
    for (std::size_t place = quadrant_[quadrant].begin; place < quadrant_[quadrant].end; ++place) {
      if (std::abs(std::hypot(x_m_[place], y_m_[place]) - radius) < kLineHalf * arm) {
        arc_[quadrant][i].push_back(static_cast<std::uint16_t>(place));
      }
    }
  }
}

InkComparison::Levels InkComparison::MeasureLevels(const Grays& gray) const {
  std::array<Histogram, kSectors> ink{}, white{};
  for (std::size_t i = 0; i < print_end_; ++i) {
    if (gray[i] < 0) continue;
    Histogram& histogram = (i < ink_end_ ? ink : white)[sector_[i]];
    ++histogram[static_cast<std::size_t>(std::lround(gray[i]))];
  }
  // Sum over a sector and its neighbours; over all sectors where these show no ink or no white.
  const auto around = [](const std::array<Histogram, kSectors>& of_sectors, int sector, int reach) {
    Histogram sum{};
    for (int s = sector - reach; s <= sector + reach; ++s) {
      const Histogram& histogram = of_sectors[(s + kSectors) % kSectors];
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += histogram[i];
    }
    return sum;
  };
  Levels levels;
  std::array<float, kSectors> ink_level{}, lit{}, contrast{};
  for (int s = 0; s < kSectors; ++s) {
    Histogram of_ink = around(ink, s, 1), of_white = around(white, s, 1);
    std::optional<float> level = Quantile(of_ink, kInk), darker = Quantile(of_white, kDarkerWhite);
    if (!level || !darker) {
      constexpr int kAll = kSectors / 2 - 1;
      of_ink = around(ink, s, kAll);
      of_white = around(white, s, kAll);
      level = Quantile(of_ink, kInk);
      darker = Quantile(of_white, kDarkerWhite);
      if (!level || !darker) return levels;
    }
    ink_level[s] = *level;
    levels.white[s] = *darker;
    lit[s] = *Quantile(of_white, kLitWhite);
    contrast[s] = levels.white[s] - ink_level[s];
  }
  // The ink in the least light is the measure: light that lies on much of the print raises the
  // rest.
  const auto darkest = std::min_element(ink_level.begin(), ink_level.end());
  levels.ink = *darkest;
  levels.veiled = *darkest + kVeiled * (*std::max_element(lit.begin(), lit.end()) - *darkest);
  std::array<float, kSectors> contrasts = contrast;
  const float median = MedianInPlace(contrasts);
  levels.has_contrast = median >= GrayContrast::kLeast;
  const float least = std::max(GrayContrast::kLeast, kLeastOfContrast * median);
  for (int s = 0; s < kSectors; ++s) {
    const float span = std::max(contrast[s], least);
    levels.per_gray[s] = 1 / span;
    levels.highlight[s] = std::min(kSaturatedGray - 4, lit[s] + kBeyondWhite * span);
  }
  return levels;
}

InkComparison::Darkness InkComparison::MeasureDarkness(const Grays& gray, const Levels& levels,
                                                       const EdgeRowsOfArms& edge_rows) const {
  Darkness darkness;
  for (std::size_t i = 0; i < x_m_.size(); ++i) {
    const int s = sector_[i];
    darkness.value[i] = (levels.white[s] - gray[i]) * levels.per_gray[s];
    darkness.is_seen[i] = gray[i] >= 0;
  }
  HideInHighlights(gray, levels, edge_rows, &darkness);
  return darkness;
}

// Returns how many rows of an arm the blur of a sharp edge may brighten.
InkComparison::EdgeRowsOfArms InkComparison::EdgeRows(const PatternView& view) const {
  EdgeRowsOfArms rows;
  for (int k = 0; k < kArms; ++k) {
    const std::size_t first = arm_[k].begin, last = arm_[k].end - kAcross;
    const std::array x_m{x_m_[first], x_m_[last]}, y_m{y_m_[first], y_m_[last]};
    std::array<float, 2> x_px, y_px;
    view.Project(x_m.data(), y_m.data(), x_m.size(), x_px.data(), y_px.data());
    const float length_px = std::hypot(x_px[1] - x_px[0], y_px[1] - y_px[0]);
    rows[k] = StrokeEdgeRows(length_px / (kAlongArm - 1), kAlongArm);
  }
  return rows;
}

// Ink that a highlight hides is out of view.
void InkComparison::HideInHighlights(const Grays& gray, const Levels& levels,
                                     const EdgeRowsOfArms& edge_rows, Darkness* darkness) const {
  const auto known = [&](std::size_t place) {
    return gray[place] < 0 ? kUnknownGray : gray[place];
  };
  float hub = kUnknownGray;
  for (const Range& arm : arm_) hub = std::min(hub, known(arm.begin));
  for (int k = 0; k < kArms; ++k) {
    for (std::size_t side = 0; side < kAcross; ++side) {
      // From the middle of the print to the ring.
      std::array<float, kAlongArm + 2> stroke;
      std::array<float, kAlongArm> highlight;
      stroke.front() = hub;
      stroke.back() = known(BeyondArm(k));
      for (std::size_t row = 0; row < highlight.size(); ++row) {
        const std::size_t place = arm_[k].begin + kAcross * row + side;
        stroke[row + 1] = known(place);
        highlight[row] = levels.highlight[sector_[place]];
      }
      const auto hidden =
          InkInHighlights(stroke, highlight, {levels.ink, levels.veiled, edge_rows[k]});
      for (std::size_t row = 0; row < highlight.size(); ++row) {
        if (hidden[row]) darkness->is_seen[arm_[k].begin + kAcross * row + side] = false;
      }
    }
  }
}

double InkComparison::Doubt(const cv::Mat& image, const PatternView& view,
                            PrintDoubts* doubts) const {
  Grays gray;
  view.Sample(image, x_m_.data(), y_m_.data(), x_m_.size(), gray.data());
  const auto ink_seen = std::count_if(gray.begin(), gray.begin() + static_cast<int>(ink_end_),
                                      [](float value) { return value >= 0; });
  const double seen = static_cast<double>(ink_seen) / static_cast<double>(ink_end_);
  PrintDoubts& all = *doubts;
  const Levels levels = MeasureLevels(gray);
  if (!levels.has_contrast) {
    all[PrintDoubt::kInklessArm] = all[PrintDoubt::kDarkBoard] = 1;
    all[PrintDoubt::kUnlike] = 0;
    return seen;
  }
  const Darkness darkness = MeasureDarkness(gray, levels, EdgeRows(view));
  DoubtCross(darkness, doubts);
  DoubtRing(darkness, doubts);
  DoubtBoard(darkness, doubts);
  InkCorrelation correlation;
  for (std::size_t i = 0; i < print_end_; ++i) {
    if (gray[i] < 0) continue;
    correlation.Add(std::clamp(darkness.value[i], 0.0f, 1.0f), i < ink_end_);
  }
  all[PrintDoubt::kUnlike] = LogShare(1 - correlation.value());
  return seen;
}

void InkComparison::DoubtCross(const Darkness& darkness, PrintDoubts* doubts) const {
  std::array<double, kArms> inkless, dark, inked, hub, spoke;
  for (int k = 0; k < kArms; ++k) {
    const double ink = darkness.Mean(arm_[k], kIsInk);
    inkless[k] = ink < 0 ? ink : 1 - ink;
    dark[k] = darkness.Mean(quadrant_[k], kIsDark);
    inked[k] = darkness.Mean(quadrant_[k], kIsInkOnly);
    hub[k] = darkness.Mean(hub_[k], kIsDark);
    spoke[k] = -1;
    for (const std::vector<std::uint16_t>& line : line_[k]) {
      spoke[k] = std::max(spoke[k], darkness.Mean(line, kIsInkOnly));
    }
  }
  PrintDoubts& all = *doubts;
  const KnownValues arms(inkless), hubs(hub), spokes(spoke);
  all[PrintDoubt::kInklessArm] = arms.empty() ? 1 : arms.FromTop(0);
  all[PrintDoubt::kDarkQuadrants] = KnownValues(dark).Least();
  all[PrintDoubt::kInkOnWhite] = KnownValues(inked).Least();
  all[PrintDoubt::kDarkHub] = hubs.FromTop(1);
  all[PrintDoubt::kOtherSpoke] = spokes.FromTop(0);
  all[PrintDoubt::kOtherSpokes] = spokes.FromTop(1);
}

void InkComparison::DoubtRing(const Darkness& darkness, PrintDoubts* doubts) const {
  std::array<double, kSectors> inkless;
  for (int s = 0; s < kSectors; ++s) {
    const double ink = darkness.Mean(ring_[s], kIsInk);
    inkless[s] = ink < 0 ? ink : 1 - ink;
  }
  (*doubts)[PrintDoubt::kBrokenRing] = KnownValues(inkless).MeanButTop();
}

void InkComparison::DoubtBoard(const Darkness& darkness, PrintDoubts* doubts) const {
  std::array<double, kSectors> board;
  double corners = 0, sides = 0;
  int corner_count = 0, side_count = 0;
  for (int s = 0; s < kSectors; ++s) {
    board[s] = darkness.Mean(board_[s], kIsDark);
    if (board[s] < 0) continue;
    (s % 2 == 0 ? corners : sides) += board[s];
    ++(s % 2 == 0 ? corner_count : side_count);
  }
  const auto other_ring = static_cast<float>(std::max(RingAround(darkness), RingInside(darkness)));
  (*doubts)[PrintDoubt::kDarkBoard] =
      std::max<double>(KnownValues(board).Median(), kIsStroke(other_ring));
  (*doubts)[PrintDoubt::kDarkCorners] =
      corners / std::max(1, corner_count) - sides / std::max(1, side_count);
}

// Returns how dark a stroke around the ring is, with white beyond it, in at least half of the
// directions. Ground beyond a small board has no white behind it.
double InkComparison::RingAround(const Darkness& darkness) const {
  double worst = 0;
  for (int k = 0; k + 1 < kPerRow; ++k) {
    std::array<float, kAroundRows> strokes;
    std::size_t seen = 0;
    for (std::size_t row = print_end_; row < x_m_.size(); row += kPerRow) {
      const bool* const is_seen = &darkness.is_seen[row];
      if (!std::all_of(is_seen, is_seen + kPerRow, std::identity())) continue;
      const float* const value = &darkness.value[row];
      const float beyond = *std::min_element(value + k + 1, value + kPerRow);
      strokes[seen++] = kIsDark(value[k]) - kIsDark(beyond);
    }
    if (static_cast<double>(seen) < kEnoughSeen * kAroundRows) return 0;
    worst = std::max<double>(worst, MedianInPlace(std::span(strokes).first(seen)));
  }
  return worst;
}

// Returns how dark an arc between the arms is, with white on both of its sides: the mean over the
// quadrants but the darkest.
double InkComparison::RingInside(const Darkness& darkness) const {
  std::array<std::array<double, kArms>, kArcs> strokes;
  for (int k = 0; k < kArms; ++k) {
    std::array<double, kArcs> dark;
    for (int i = 0; i < kArcs; ++i) dark[i] = darkness.Mean(arc_[k][i], kInAnyLight);
    for (int i = 1; i + 1 < kArcs; ++i) {
      const double within = *std::min_element(dark.begin(), dark.begin() + i);
      const double beyond = *std::min_element(dark.begin() + i + 1, dark.end());
      strokes[i][k] =
          within < 0 || beyond < 0 ? -1 : std::max(0.0, 2 * (dark[i] - std::max(within, beyond)));
    }
  }
  double worst = 0;
  for (int i = 1; i + 1 < kArcs; ++i) {
    worst = std::max(worst, KnownValues(strokes[i]).MeanButTop());
  }
  return worst;
}

}  // namespace kestrel
