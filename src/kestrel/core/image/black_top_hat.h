// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/core/image/binary_image.h"

namespace kestrel {

// Finds narrow dark strokes in any light (black top-hat; Serra, 1982): closing with a square takes
// out of an image what is dark and narrower than the square, and leaves the light there, shadows
// and their edges included. A pixel is dark when it is nearer to the darkest pixel of the square
// around it than to the light, by two thirds of the way: the blur fills narrow strokes with gray.
// It is bright when it has three quarters of the way. The inside of what is wider is neither.
class BlackTopHat {
 public:
  static constexpr int kSquarePx = 5;

  // 'image': CV_8UC1. 'min_contrast' >= 1: gray values between light and darkest pixel below which
  // a pixel is neither. Does not allocate once it has seen an image of the same size.
  void Binarize(const cv::Mat& image, int min_contrast, BinaryImage* binary);

 private:
  static constexpr int kReach = kSquarePx / 2;

  // A byte per pixel, row by row.
  using Plane = std::vector<std::uint8_t>;
  // Of kSquarePx rows.
  using Rows = std::array<const std::uint8_t*, kSquarePx>;

  void FilterRow(const Rows& rows, int width, bool largest, std::uint8_t* out);

  Plane brightest_;  // of the square around each pixel
  Plane darkest_;
  Plane column_;  // of the columns of a row of squares, kReach beyond its ends
  Plane light_;   // of a row
  Thresholds row_;
};

}  // namespace kestrel
