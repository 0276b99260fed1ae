// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/image/border_tracing.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <limits>
#include <span>

namespace kestrel {
namespace {

// Directions of a step, clockwise in the image (y down).
enum Direction { kRight = 0, kDown = 1, kLeft = 2, kUp = 3 };
constexpr int kStepX[4] = {1, 0, -1, 0};
constexpr int kStepY[4] = {0, 1, 0, -1};

// Pixels ahead of a vertex on the left and on the right of the walking direction, relative to the
// pixel whose upper left corner the vertex is.
constexpr int kLeftX[4] = {0, 0, -1, -1};
constexpr int kLeftY[4] = {-1, 0, 0, -1};
constexpr int kRightX[4] = {0, -1, -1, 0};
constexpr int kRightY[4] = {0, 0, -1, -1};

// The pixels of a word beside which the left and the right pixel are bright, with 'narrow' one of
// them.
std::uint64_t BesideBright(const std::uint64_t* bright, int word, int words, bool narrow) {
  const std::uint64_t next = word + 1 < words ? bright[word + 1] : 0;
  const std::uint64_t left = bright[word] << 1 | bright[word - 1] >> 63;
  const std::uint64_t right = bright[word] >> 1 | next << 63;
  return narrow ? left | right : left & right;
}

// How often the size of a border is compared with the limit.
constexpr std::size_t kCheckInterval = 32;

// Bounding box of points.
struct Extent {
  static constexpr std::int16_t kMost = std::numeric_limits<std::int16_t>::max();
  GridPoint min{kMost, kMost};
  GridPoint max{-1, -1};

  void Add(std::span<const GridPoint> points) {
    for (const GridPoint& point : points) {
      min = {std::min(min.x, point.x), std::min(min.y, point.y)};
      max = {std::max(max.x, point.x), std::max(max.y, point.y)};
    }
  }
  int Longer() const { return std::max(max.x - min.x, max.y - min.y); }
  int Shorter() const { return std::min(max.x - min.x, max.y - min.y); }
};

// Area within a closed walk, by Green's theorem: only steps along y sweep area.
std::int32_t SignedArea(std::span<const GridPoint> points) {
  std::int32_t area = 0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    area += points[i].x * (points[i + 1].y - points[i].y);
  }
  return area + points.back().x * (points.front().y - points.back().y);
}

// Median over places along a border of how much brighter the second pixel on its left is than the
// first on its right.
int ContrastAcross(const cv::Mat& image, const GridPoint* points, std::size_t count) {
  constexpr std::size_t kPlaces = 8;
  std::array<int, kPlaces> contrast;
  std::size_t seen = 0;
  for (std::size_t i = 0; i < kPlaces; ++i) {
    const std::size_t at = i * count / kPlaces;
    const GridPoint& from = points[at];
    const GridPoint& to = points[at + 1 < count ? at + 1 : 0];
    const cv::Point step(to.x - from.x, to.y - from.y);
    const cv::Point to_left(step.y, -step.x);
    const cv::Point dark(from.x - static_cast<int>(step.x < 0 || step.y > 0),
                         from.y - static_cast<int>(step.x < 0 || step.y < 0));
    const cv::Point bright = dark + 2 * to_left;
    if (!cv::Rect({0, 0}, image.size()).contains(bright)) continue;
    contrast[seen++] = image.at<std::uint8_t>(bright) - image.at<std::uint8_t>(dark);
  }
  if (seen == 0) return 0;
  const auto middle = contrast.begin() + static_cast<std::ptrdiff_t>(seen / 2);
  std::nth_element(contrast.begin(), middle, contrast.begin() + static_cast<std::ptrdiff_t>(seen));
  return *middle;
}

}  // namespace

void BorderTracer::Reserve(int width, int height) {
  constexpr std::size_t kLeast = 4096;
  const std::size_t pixels = static_cast<std::size_t>(width) * height;
  points_.resize(std::max(points_.size(), pixels / 2 + kLeast));
  borders_.reserve(pixels / 64 + kLeast / 64);
  strengths_.reserve(borders_.capacity());
  traced_.Reset(width, height);
}

void BorderTracer::Trace(const BinaryImage& binary, const cv::Rect& region,
                         const BorderLimits& limits) {
  Clear();
  const BitImage& dark = binary.dark;
  Reserve(dark.width(), dark.height());
  const int first_word = region.x / 64;
  const int last_word = (region.x + region.width + 63) / 64;
  for (int y = region.y; y < region.y + region.height; ++y) {
    const std::uint64_t* above = dark.row(y - 1);
    const std::uint64_t* here = dark.row(y);
    const std::uint64_t* bright = binary.bright.row(std::max(y - 2, -1));
    const std::uint64_t* traced = traced_.row(y);
    for (int word = first_word; word < last_word; ++word) {
      std::uint64_t candidates = here[word] & ~above[word] & bright[word];
      if (candidates == 0) continue;
      candidates &= BesideBright(bright, word, dark.words_per_row(), limits.narrow);
      // Of a run of neighbouring candidates one is enough.
      std::uint64_t starts = candidates & ~(candidates << 1);
      while ((starts &= ~traced[word]) != 0) {
        TraceFrom(dark, 64 * word + std::countr_zero(starts), y, limits);
        starts &= starts - 1;
      }
    }
  }
}

void BorderTracer::KeepStrongest(const cv::Mat& image, std::size_t most) {
  if (borders_.size() <= most) return;
  strengths_.clear();
  for (std::size_t i = 0; i < borders_.size(); ++i) {
    strengths_.push_back({ContrastAcross(image, begin(borders_[i]), borders_[i].count), i});
  }
  const auto last = strengths_.begin() + static_cast<std::ptrdiff_t>(most);
  std::nth_element(strengths_.begin(), last, strengths_.end(),
                   [](const Strength& a, const Strength& b) { return a.contrast > b.contrast; });
  std::sort(strengths_.begin(), last,
            [](const Strength& a, const Strength& b) { return a.border < b.border; });
  for (std::size_t i = 0; i < most; ++i) borders_[i] = borders_[strengths_[i].border];
  borders_.resize(most);
}

// Room for the points of one more border; empty when there is none.
std::span<GridPoint> BorderTracer::Room() {
  if (borders_.size() == borders_.capacity()) return {};
  return std::span(points_).subspan(used_);
}

void BorderTracer::TraceFrom(const BitImage& dark, int x, int y, const BorderLimits& limits) {
  const std::span<GridPoint> room = Room();
  // Pixels are addressed by the number of their bit, so that a step is one addition.
  const std::uint64_t* words = dark.row(0);
  std::uint64_t* traced = traced_.row(0);
  const std::ptrdiff_t stride = std::ptrdiff_t{64} * dark.words_per_row();
  const auto bit = [words](std::ptrdiff_t index) {
    return static_cast<int>((words[index >> 6] >> (index & 63)) & 1);
  };
  std::array<std::ptrdiff_t, 4> step, left, right;
  for (int d = 0; d < 4; ++d) {
    step[d] = kStepY[d] * stride + kStepX[d];
    left[d] = kLeftY[d] * stride + kLeftX[d];
    right[d] = kRightY[d] * stride + kRightX[d];
  }

  const std::ptrdiff_t start = y * stride + x;
  std::ptrdiff_t at = start;
  int direction = kRight;
  std::size_t count = 0;
  Extent extent;
  bool closed = false;
  while (!closed) {
    // The limits are looked at after some steps at a time: a step is short.
    const std::size_t first = count;
    const std::size_t last = std::min(count + kCheckInterval, room.size());
    bool walked = first == last;  // no room, or where a border that was given up was walked
    while (count < last && !closed && !walked) {
      room[count++] = {static_cast<std::int16_t>(x), static_cast<std::int16_t>(y)};
      // Steps to the right walk along the upper edge of a pixel: computed instead of branched on,
      // as in texture every second turn would be predicted wrong.
      const std::uint64_t upper = std::uint64_t{direction == kRight} << (at & 63);
      std::uint64_t& traced_word = traced[at >> 6];
      walked = (traced_word & upper) != 0;
      traced_word |= upper;
      x += kStepX[direction];
      y += kStepY[direction];
      at += step[direction];
      // Dark areas are 8-connected: a dark pixel on the left turns left, even where it touches the
      // one on the right at the vertex only; without either the border turns right.
      const int is_left = bit(at + left[direction]);
      const int is_right = bit(at + right[direction]);
      direction = (direction + 3 * is_left + ((is_left | is_right) ^ 1)) & 3;
      closed = at == start && direction == kRight;
    }
    extent.Add(room.subspan(first, count - first));
    if (walked || extent.Longer() > limits.max_extent) return;
  }
  if (count < limits.min_count || extent.Shorter() < limits.min_extent) return;
  borders_.push_back({.first = used_,
                      .count = count,
                      .signed_area = SignedArea(room.first(count)),
                      .min = extent.min,
                      .max = extent.max});
  used_ += count;
}

}  // namespace kestrel
