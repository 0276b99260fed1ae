// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/image/border_tracing.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>

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

// How often the size of a border is compared with the limit.
constexpr std::size_t kCheckInterval = 32;

}  // namespace

void BorderTracer::Reserve(int width, int height) {
  constexpr std::size_t kLeast = 4096;
  const std::size_t pixels = static_cast<std::size_t>(width) * height;
  points_.reserve(pixels / 2 + kLeast);
  borders_.reserve(pixels / 64 + kLeast / 64);
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
      const std::uint64_t next = word + 1 < dark.words_per_row() ? bright[word + 1] : 0;
      candidates &= (bright[word] << 1 | bright[word - 1] >> 63) & (bright[word] >> 1 | next << 63);
      if (candidates == 0) continue;
      // Of a run of neighbouring candidates one is enough.
      std::uint64_t starts = candidates & ~(candidates << 1);
      while ((starts &= ~traced[word]) != 0) {
        TraceFrom(dark, 64 * word + std::countr_zero(starts), y, limits);
        starts &= starts - 1;
      }
    }
  }
}

void BorderTracer::TraceFrom(const BitImage& dark, int x, int y, const BorderLimits& limits) {
  // Pixels are addressed by the number of their bit, so that a step is one addition.
  const std::uint64_t* words = dark.row(0);
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

  Border border;
  border.first = points_.size();
  if (borders_.size() == borders_.capacity()) return;
  const std::ptrdiff_t start = y * stride + x;
  std::ptrdiff_t at = start;
  int direction = kRight;
  int min_x = x, max_x = x, min_y = y, max_y = y;
  std::int32_t area = 0;
  bool kept = true;
  do {
    if (points_.size() == points_.capacity()) {
      kept = false;
      break;
    }
    points_.push_back({static_cast<std::int16_t>(x), static_cast<std::int16_t>(y)});
    if (direction == kRight) {
      // An edge that was walked along before belongs to a border that was given up.
      if (traced_.at(x, y)) kept = false;
      traced_.Set(x, y);
    }
    // Green's theorem: only steps along y sweep area.
    area += x * kStepY[direction];
    x += kStepX[direction];
    y += kStepY[direction];
    at += step[direction];
    min_x = std::min(min_x, x);
    max_x = std::max(max_x, x);
    min_y = std::min(min_y, y);
    max_y = std::max(max_y, y);
    if ((points_.size() - border.first) % kCheckInterval == 0 &&
        std::max(max_x - min_x, max_y - min_y) > limits.max_extent) {
      kept = false;
    }
    // Dark areas are 8-connected: a dark pixel on the left turns left, even where it touches the
    // one on the right at the vertex only; without either the border turns right. In texture
    // every second turn would be predicted wrong: it is computed instead of branched on.
    const int is_left = bit(at + left[direction]);
    const int is_right = bit(at + right[direction]);
    direction = (direction + 3 * is_left + ((is_left | is_right) ^ 1)) & 3;
  } while (kept && (at != start || direction != kRight));

  border.count = points_.size() - border.first;
  if (!kept || border.count < limits.min_count || max_x - min_x < limits.min_extent ||
      max_y - min_y < limits.min_extent ||
      std::max(max_x - min_x, max_y - min_y) > limits.max_extent) {
    points_.resize(border.first);
    return;
  }
  border.signed_area = area;
  border.min = {static_cast<std::int16_t>(min_x), static_cast<std::int16_t>(min_y)};
  border.max = {static_cast<std::int16_t>(max_x), static_cast<std::int16_t>(max_y)};
  borders_.push_back(border);
}

}  // namespace kestrel
