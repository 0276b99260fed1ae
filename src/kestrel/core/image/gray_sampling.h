// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <opencv2/core.hpp>

namespace kestrel {

// From this gray value on, a pixel is saturated: it may have been brighter.
inline constexpr float kSaturatedGray = 254;

// Returns the bilinear gray value of a CV_8UC1 image of at least 2 x 2 pixels; negative outside of
// the image and for NaN.
inline float SampleGray(const cv::Mat& image, float x, float y) {
  const bool inside = x >= 0 && y >= 0 && x <= static_cast<float>(image.cols - 1) &&
                      y <= static_cast<float>(image.rows - 1);
  if (!inside) return -1;
  const int x0 = std::min(static_cast<int>(x), image.cols - 2);
  const int y0 = std::min(static_cast<int>(y), image.rows - 2);
  const float fx = x - static_cast<float>(x0);
  const float fy = y - static_cast<float>(y0);
  const std::uint8_t* upper = image.data + image.step[0] * y0 + x0;
  const std::uint8_t* lower = upper + image.step[0];
  const float top = upper[0] + fx * static_cast<float>(upper[1] - upper[0]);
  const float bottom = lower[0] + fx * static_cast<float>(lower[1] - lower[0]);
  return top + fy * (bottom - top);
}

// The same at 'count' places, with the best vector instructions of the machine, chosen at run time.
// The image must have less than 2 GB. The arrays must not overlap.
void SampleGrays(const cv::Mat& image, const float* x, const float* y, std::size_t count,
                 float* gray);

}  // namespace kestrel
