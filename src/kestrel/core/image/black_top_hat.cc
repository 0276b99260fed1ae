// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/image/black_top_hat.h"

#include <algorithm>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kestrel/core/image/black_top_hat.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace kestrel {
namespace HWY_NAMESPACE {

// Largest or smallest of the five values at each of 'count' places.
template <bool kLargest>
void Extreme(const std::uint8_t* HWY_RESTRICT a, const std::uint8_t* HWY_RESTRICT b,
             const std::uint8_t* HWY_RESTRICT c, const std::uint8_t* HWY_RESTRICT d,
             const std::uint8_t* HWY_RESTRICT e, std::size_t count,
             std::uint8_t* HWY_RESTRICT out) {
  const auto better = [](std::uint8_t p, std::uint8_t q) {
    return kLargest ? (p > q ? p : q) : (p < q ? p : q);
  };
  for (std::size_t i = 0; i < count; ++i) {
    out[i] = better(better(better(a[i], b[i]), better(c[i], d[i])), e[i]);
  }
}

void ExtremeOfFive(const std::uint8_t* const* rows, std::size_t count, bool largest,
                   std::uint8_t* out) {
  if (largest) {
    Extreme<true>(rows[0], rows[1], rows[2], rows[3], rows[4], count, out);
  } else {
    Extreme<false>(rows[0], rows[1], rows[2], rows[3], rows[4], count, out);
  }
}

void StrokeThresholds(const std::uint8_t* HWY_RESTRICT light,
                      const std::uint8_t* HWY_RESTRICT darkest, std::size_t count, int min_contrast,
                      std::uint8_t* HWY_RESTRICT dark, std::uint8_t* HWY_RESTRICT bright) {
  const auto least = static_cast<std::uint8_t>(min_contrast < 255 ? min_contrast : 255);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t contrast = light[i] - darkest[i];
    // 171 / 256 is two thirds.
    const auto two_thirds = static_cast<std::uint8_t>((contrast * 171u) >> 8);
    const std::uint8_t below = darkest[i] + two_thirds;
    const std::uint8_t above = light[i] - (contrast >> 2);
    dark[i] = contrast >= least ? below : 0;
    bright[i] = contrast >= least ? above : 255;
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace kestrel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace kestrel {
namespace {

HWY_EXPORT(ExtremeOfFive);
HWY_EXPORT(StrokeThresholds);

}  // namespace

// Computes the largest or smallest value of the square around each pixel of the middle row.
void BlackTopHat::FilterRow(const Rows& rows, int width, bool largest, std::uint8_t* out) {
  std::uint8_t* const column = column_.data() + kReach;
  HWY_DYNAMIC_DISPATCH(ExtremeOfFive)(rows.data(), width, largest, column);
  std::fill_n(column - kReach, kReach, column[0]);
  std::fill_n(column + width, kReach, column[width - 1]);
  static_assert(kSquarePx == 5, "as many rows as ExtremeOfFive takes");
  Rows shifted;
  for (int i = 0; i < kSquarePx; ++i) shifted[i] = column + i - kReach;
  HWY_DYNAMIC_DISPATCH(ExtremeOfFive)(shifted.data(), width, largest, out);
}

void BlackTopHat::Binarize(const cv::Mat& image, int min_contrast, BinaryImage* binary) {
  const int width = image.cols, height = image.rows;
  binary->dark.Reset(width, height);
  binary->bright.Reset(width, height);
  if (image.empty()) return;
  const std::size_t stride = width;
  brightest_.resize(stride * height);
  darkest_.resize(stride * height);
  column_.resize(stride + 2 * kReach);
  light_.resize(stride);
  row_.ResetRow(width);
  // Returns the rows around 'y'; the first and the last row are repeated.
  const auto rows_around = [height](int y, const auto& row) {
    Rows rows;
    for (int i = 0; i < kSquarePx; ++i) rows[i] = row(std::clamp(y + i - kReach, 0, height - 1));
    return rows;
  };
  const auto row_of_image = [&image](int y) { return image.ptr(y); };
  const auto row_of_brightest = [&](int y) { return brightest_.data() + stride * y; };
  for (int y = 0; y < height; ++y) {
    const Rows rows = rows_around(y, row_of_image);
    FilterRow(rows, width, true, brightest_.data() + stride * y);
    FilterRow(rows, width, false, darkest_.data() + stride * y);
  }
  for (int y = 0; y < height; ++y) {
    FilterRow(rows_around(y, row_of_brightest), width, false, light_.data());
    HWY_DYNAMIC_DISPATCH(StrokeThresholds)
    (light_.data(), darkest_.data() + stride * y, stride, min_contrast, row_.dark.data(),
     row_.bright.data());
    BinarizeRow(image.ptr(y), width, row_, y, binary);
  }
}

}  // namespace kestrel
#endif  // HWY_ONCE
