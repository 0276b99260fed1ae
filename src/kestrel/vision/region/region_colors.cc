// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/region/region_colors.h"

#include <algorithm>
#include <cmath>

namespace kestrel {
namespace {

constexpr int kLevels = 16;  // of a channel; of gray images all of the 256
constexpr int kColors = kLevels * kLevels * kLevels;
constexpr float kRate = 0.05f;     // of the colours around it, by one image
constexpr double kGap = 1.3;       // sizes of the box, from where on a pixel is around it
constexpr double kInner = 0.6;     // of the box: there the region is for sure
constexpr double kNearest = 0.4;   // half sizes of the box, from its middle to the region's end
constexpr double kFarthest = 2;    // the same, at most
constexpr double kCore = 0.8;      // of the box: there most is the region
constexpr float kMostOfColor = 3;  // times as much of it as in the region: it may be seen in part
constexpr int kHuesPerSextant = 4;
constexpr int kGray = 6 * kHuesPerSextant;  // beside the hues
constexpr double kLeastMarkedHues = 0.2;    // share of the box, from which on they must be seen
constexpr double kLeastHues = 0.3;          // of those that were marked
constexpr float kLeastClear = 0.3f;         // probability within the box, less that around it
constexpr float kEdge = 0.4f;  // of the way from the probability around the box to that within

int LevelOf(float value) {
  return std::clamp(static_cast<int>(value) * kLevels / 256, 0, kLevels - 1);
}

int ColorAt(const SampledWindow& window, std::size_t i) {
  if (window.planes == 1) return std::clamp(static_cast<int>(window.values[0][i]), 0, 255);
  return (LevelOf(window.values[0][i]) * kLevels + LevelOf(window.values[1][i])) * kLevels +
         LevelOf(window.values[2][i]);
}

// Returns the hue of HSV in steps; kGray where its channels differ too little.
int HueAt(const SampledWindow& window, std::size_t i) {
  constexpr float kDark = 8;  // added to each channel: the noise of a dark pixel is no hue
  constexpr float kLeastSpread = 0.1f;
  if (window.planes == 1) return kGray;
  const float blue = window.values[0][i], green = window.values[1][i], red = window.values[2][i];
  const auto [least, most] = std::minmax({blue, green, red});
  const float spread = most - least;
  if (spread < kLeastSpread * (blue + green + red + 3 * kDark)) return kGray;
  const float sextant = most == red     ? 6 + (green - blue) / spread
                        : most == green ? 2 + (blue - red) / spread
                                        : 4 + (red - green) / spread;
  return static_cast<int>(sextant * kHuesPerSextant) % kGray;
}

}  // namespace

RegionColors::RegionColors(int side)
    : side_(side),
      colors_(kColors),
      hues_(kGray + 1),
      core_(kColors),
      profile_(side),
      sums_(std::size_t(side + 1) * (side + 1)) {}

void RegionColors::Mark(const SampledWindow& window, const Box& box) {
  Count(window, box);
  colors_.Restart();
  hues_.Restart();
  marked_ = CompareWithOutline(window, box);
  marked_hues_ = ShareOfHues(window, box);
  usual_share_ = ShareInAnyLight(window, box);
}

void RegionColors::LearnAround(const SampledWindow& window, const Box& box) {
  Count(window, box);
  colors_.LearnAround(kRate);
  hues_.LearnAround(kRate);
  usual_share_ += kRate * (ShareInAnyLight(window, box) - usual_share_);
}

void RegionColors::Count(const SampledWindow& window, const Box& box) {
  for (int y = 0; y < side_; ++y) {
    const double away_y = 2 * std::abs(y - box.middle.y()) / box.size.y();
    for (int x = 0; x < side_; ++x) {
      const double away = std::max(away_y, 2 * std::abs(x - box.middle.x()) / box.size.x());
      if (away > 1 && away < kGap) continue;
      const std::size_t i = std::size_t(y) * side_ + x;
      colors_.Count(ColorAt(window, i), away <= 1);
      hues_.Count(HueAt(window, i), away <= 1);
    }
  }
}

float RegionColors::ProbabilityInAnyLight(const SampledWindow& window, std::size_t pixel) const {
  return std::max(colors_.ProbabilityOf(ColorAt(window, pixel)), HueProbability(window, pixel));
}

// Returns 0 where a pixel is gray, which in other light is any gray, or its hue unknown.
float RegionColors::HueProbability(const SampledWindow& window, std::size_t pixel) const {
  const int hue = HueAt(window, pixel);
  return hue != kGray && hues_.IsKnown(hue) ? hues_.ProbabilityOf(hue) : 0;
}

std::optional<RegionColors::Box> RegionColors::CompareWithOutline(const SampledWindow& window,
                                                                  const Box& box) {
  constexpr double kLeast = 0.7, kMost = 2, kAside = 0.4;  // a person marks more than the thing
  const auto outline = Outline(window, box);
  if (!outline) return std::nullopt;
  const Box part{(box.middle - outline->middle).cwiseQuotient(outline->size),
                 box.size.cwiseQuotient(outline->size)};
  const bool is_alike = part.size.minCoeff() > kLeast && part.size.maxCoeff() < kMost &&
                        part.middle.cwiseAbs().maxCoeff() < kAside;
  if (!is_alike) return std::nullopt;
  return part;
}

std::optional<RegionColors::Box> RegionColors::Fit(const SampledWindow& window, const Box& box) {
  if (!marked_) return std::nullopt;
  const auto outline = Outline(window, box);
  if (!outline) return std::nullopt;
  return Box{outline->middle + marked_->middle.cwiseProduct(outline->size),
             marked_->size.cwiseProduct(outline->size)};
}

bool RegionColors::HasHues() const { return marked_hues_ > kLeastMarkedHues; }

double RegionColors::AgreementOf(const SampledWindow& window, const Box& box) const {
  return AreHuesMissing(window, box) ? 0 : ShareInAnyLight(window, box) / usual_share_;
}

bool RegionColors::AreHuesMissing(const SampledWindow& window, const Box& box) const {
  return HasHues() && ShareOfHues(window, box) < kLeastHues * marked_hues_;
}

double RegionColors::ShareInAnyLight(const SampledWindow& window, const Box& box) const {
  double sum = 0;
  const int pixels =
      ForEachInCore(box, [&](std::size_t i) { sum += ProbabilityInAnyLight(window, i); });
  return sum / pixels;
}

// Returns the share of the pixels that have a hue of the region.
double RegionColors::ShareOfHues(const SampledWindow& window, const Box& box) const {
  constexpr float kLeast = 0.6f;
  double sum = 0;
  const int pixels =
      ForEachInCore(box, [&](std::size_t i) { sum += HueProbability(window, i) > kLeast; });
  return sum / pixels;
}

double RegionColors::MatchOf(const SampledWindow& window, const Box& box) {
  if (AreHuesMissing(window, box)) return 0;
  const bool by_hue = HasHues();
  std::ranges::fill(core_, 0.0f);
  const int pixels = ForEachInCore(box, [&](std::size_t i) {
    const int bin = by_hue ? HueAt(window, i) : ColorAt(window, i);
    core_[bin] += by_hue ? ProbabilityInAnyLight(window, i) : colors_.ProbabilityOf(bin);
  });
  const ColorShares& shares = by_hue ? hues_ : colors_;
  double sum = 0;
  for (int i = 0; i < shares.size(); ++i) {
    const float most = shares.IsKnown(i) ? kMostOfColor * shares.Inside(i) : 1;
    sum += std::min(core_[i] / static_cast<float>(pixels), most);
  }
  return sum / usual_share_;
}

// Visits the pixels in the inner part of the box, where most are the region's; returns how many.
template <typename Visitor>
int RegionColors::ForEachInCore(const Box& box, const Visitor& visit) const {
  const auto limit = [&](double at) {
    return std::clamp(static_cast<int>(std::lround(at)), 0, side_ - 1);
  };
  const Eigen::Vector2d half = 0.5 * kCore * box.size;
  const int left = limit(box.middle.x() - half.x()), right = limit(box.middle.x() + half.x());
  const int top = limit(box.middle.y() - half.y()), bottom = limit(box.middle.y() + half.y());
  for (int y = top; y <= bottom; ++y) {
    for (int x = left; x <= right; ++x) visit(std::size_t(y) * side_ + x);
  }
  return (right - left + 1) * (bottom - top + 1);
}

RegionColors::Place RegionColors::Find(const SampledWindow& window, const Eigen::Vector2d& size) {
  SumUp(window);
  const Eigen::Vector2i box = size.array().round().cast<int>().max(1).min(side_).matrix();
  Place best{{}, -1};
  for (Eigen::Vector2i at(0, 0); at.y() + box.y() <= side_; ++at.y()) {
    for (at.x() = 0; at.x() + box.x() <= side_; ++at.x()) {
      const double contrast = ContrastOf(at, box);
      if (contrast <= best.contrast) continue;
      const Eigen::Vector2d inner = 0.5 * (box - Eigen::Vector2i::Ones()).cast<double>();
      best = {{at.cast<double>() + inner, size}, contrast};
    }
  }
  return best;
}

void RegionColors::SumUp(const SampledWindow& window) {
  const int stride = side_ + 1;
  for (int y = 0; y < side_; ++y) {
    float row = 0;
    for (int x = 0; x < side_; ++x) {
      row += colors_.ProbabilityOf(ColorAt(window, std::size_t(y) * side_ + x));
      sums_[(y + 1) * stride + x + 1] = sums_[y * stride + x + 1] + row;
    }
  }
}

// Returns the mean probability in the box that begins at 'first', less that in the frame around it,
// which is half as wide as the box.
double RegionColors::ContrastOf(const Eigen::Vector2i& first, const Eigen::Vector2i& size) const {
  const auto sum = [&](const Eigen::Vector2i& from, const Eigen::Vector2i& to) {
    const int stride = side_ + 1;
    return sums_[to.y() * stride + to.x()] - sums_[from.y() * stride + to.x()] -
           sums_[to.y() * stride + from.x()] + sums_[from.y() * stride + from.x()];
  };
  const Eigen::Vector2i end = first + size, half = size / 2;
  const Eigen::Vector2i from = (first - half).cwiseMax(0), to = (end + half).cwiseMin(side_);
  const float within = sum(first, end), area = static_cast<float>(size.prod());
  const float frame = static_cast<float>((to - from).prod()) - area;
  return within / area - (sum(from, to) - within) / std::max(1.0f, frame);
}

// Returns the box around the region's colours near 'box'; nothing where they end nowhere, or are
// those around it as well.
std::optional<RegionColors::Box> RegionColors::Outline(const SampledWindow& window,
                                                       const Box& box) {
  const auto x = ExtentAlong(0, window, box), y = ExtentAlong(1, window, box);
  if (!x || !y) return std::nullopt;
  return Box{{0.5 * (x->first + x->last), 0.5 * (y->first + y->last)},
             {x->last - x->first, y->last - y->first}};
}

void RegionColors::Project(const SampledWindow& window, int axis, Band across) {
  const int along_step = axis == 0 ? 1 : side_, across_step = axis == 0 ? side_ : 1;
  for (int i = 0; i < side_; ++i) {
    float sum = 0;
    for (int k = across.first; k <= across.last; ++k) {
      const std::size_t pixel = std::size_t(i) * along_step + std::size_t(k) * across_step;
      sum += colors_.ProbabilityOf(ColorAt(window, pixel));
    }
    profile_[i] = sum / static_cast<float>(across.last - across.first + 1);
  }
}

std::optional<RegionColors::Extent> RegionColors::ExtentAlong(int axis, const SampledWindow& window,
                                                              const Box& box) {
  const int other = 1 - axis;
  const double half = 0.5 * box.size[axis];
  const double reach = 0.5 * kInner * box.size[other];
  const Band across{std::max(0, static_cast<int>(std::ceil(box.middle[other] - reach))),
                    std::min(side_ - 1, static_cast<int>(std::floor(box.middle[other] + reach)))};
  if (across.last < across.first) return std::nullopt;
  Project(window, axis, across);
  float within = 0, beyond = 0;
  int count_within = 0, count_beyond = 0;
  for (int i = 0; i < side_; ++i) {
    const double away = std::abs(i - box.middle[axis]) / half;
    if (away < kInner) within += profile_[i], ++count_within;
    if (away > kFarthest) beyond += profile_[i], ++count_beyond;
  }
  if (count_within == 0 || count_beyond == 0) return std::nullopt;
  within /= static_cast<float>(count_within);
  beyond /= static_cast<float>(count_beyond);
  if (within - beyond < kLeastClear) return std::nullopt;
  const float edge = beyond + kEdge * (within - beyond);
  const auto first = EndOf(box.middle[axis], half, edge, -1);
  const auto last = EndOf(box.middle[axis], half, edge, 1);
  if (!first || !last) return std::nullopt;
  return Extent{*first, *last};
}

// From the middle on in steps; nothing where the profile stays above the edge.
std::optional<double> RegionColors::EndOf(double middle, double half, float edge, int step) const {
  const double from = middle + step * kNearest * half, most = kFarthest * half;
  for (int i = static_cast<int>(std::lround(from));; i += step) {
    const int next = i + step;
    if (std::min(i, next) < 0 || std::max(i, next) >= side_ || std::abs(i - middle) > most) {
      return std::nullopt;
    }
    if (profile_[next] >= edge) continue;
    const float drop = profile_[i] - profile_[next];
    const float part = drop > 0 ? std::clamp((profile_[i] - edge) / drop, 0.0f, 1.0f) : 0.0f;
    return i + step * part;
  }
}

}  // namespace kestrel
