// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/region/region_colors.h"

#include <algorithm>
#include <cmath>

namespace kestrel {
namespace {

constexpr int kLevels = 16;  // of a channel; of gray images all of the 256
constexpr int kColors = kLevels * kLevels * kLevels;
constexpr float kRate = 0.05f;       // of the colours around it, by one image
constexpr double kGap = 1.3;         // sizes of the box, from where on a pixel is around it
constexpr double kInner = 0.6;       // of the box: there the region is for sure
constexpr double kNearest = 0.4;     // half sizes of the box, from its middle to the region's end
constexpr double kFarthest = 2;      // the same, at most
constexpr float kLeastClear = 0.3f;  // probability within the box, less that around it
constexpr float kEdge = 0.4f;  // of the way from the probability around the box to that within

int LevelOf(float value) {
  return std::clamp(static_cast<int>(value) * kLevels / 256, 0, kLevels - 1);
}

int ColorAt(const SampledWindow& window, std::size_t i) {
  if (window.planes == 1) return std::clamp(static_cast<int>(window.values[0][i]), 0, 255);
  return (LevelOf(window.values[0][i]) * kLevels + LevelOf(window.values[1][i])) * kLevels +
         LevelOf(window.values[2][i]);
}

// Makes the sum 1; false where it is 0.
bool Normalize(std::vector<float>* shares) {
  float sum = 0;
  for (const float share : *shares) sum += share;
  if (sum == 0) return false;
  for (float& share : *shares) share /= sum;
  return true;
}

}  // namespace

RegionColors::RegionColors(int side)
    : side_(side),
      inside_(kColors),
      around_(kColors),
      new_inside_(kColors),
      new_around_(kColors),
      probability_(kColors),
      profile_(side) {}

void RegionColors::Mark(const SampledWindow& window, const Box& box) {
  Count(window, box);
  inside_ = new_inside_;
  around_ = new_around_;
  Rate();
}

void RegionColors::LearnAround(const SampledWindow& window, const Box& box) {
  Count(window, box);
  for (int i = 0; i < kColors; ++i) around_[i] += kRate * (new_around_[i] - around_[i]);
  Rate();
}

void RegionColors::Count(const SampledWindow& window, const Box& box) {
  std::ranges::fill(new_inside_, 0);
  std::ranges::fill(new_around_, 0);
  for (int y = 0; y < side_; ++y) {
    const double away_y = 2 * std::abs(y - box.middle.y()) / box.size.y();
    for (int x = 0; x < side_; ++x) {
      const double away = std::max(away_y, 2 * std::abs(x - box.middle.x()) / box.size.x());
      if (away > 1 && away < kGap) continue;
      ++(away <= 1 ? new_inside_ : new_around_)[ColorAt(window, std::size_t(y) * side_ + x)];
    }
  }
  if (!Normalize(&new_inside_) || !Normalize(&new_around_)) {
    new_inside_ = inside_;
    new_around_ = around_;
  }
}

void RegionColors::Rate() {
  constexpr float kUnknown = 1e-4f;  // share of a colour that is known of neither
  for (int i = 0; i < kColors; ++i) {
    probability_[i] = (inside_[i] + 0.5f * kUnknown) / (inside_[i] + around_[i] + kUnknown);
  }
}

std::optional<RegionColors::Box> RegionColors::Fit(const SampledWindow& window, const Box& box) {
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
      sum +=
          probability_[ColorAt(window, std::size_t(i) * along_step + std::size_t(k) * across_step)];
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
