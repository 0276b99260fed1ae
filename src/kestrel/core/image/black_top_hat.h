// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/core/image/binary_image.h"

namespace kestrel {

// Finds narrow dark strokes in any light (black top-hat; Serra 1982). Closing with a square removes
// from an image the dark parts narrower than the square, and leaves the light, including shadows
// and their edges. On the way from the darkest pixel of the square to the light, a pixel below two
// thirds is dark (not below half: the blur fills narrow strokes with gray), and one above three
// quarters is bright. The inside of wider areas is undecided.
class BlackTopHat {
 public:
  static constexpr int kSquarePx = 5;

  // 'image': CV_8UC1. 'min_contrast' >= 1: least difference of gray values between light and
  // darkest pixel at which a pixel is decided. Does not allocate once it has seen an image of this
  // size.
  void Binarize(const cv::Mat& image, int min_contrast, BinaryImage* binary);

 private:
  static constexpr int kReach = kSquarePx / 2;

  // A byte per pixel, row by row.
  using Plane = std::vector<std::uint8_t>;
  // kSquarePx rows.
  using Rows = std::array<const std::uint8_t*, kSquarePx>;

  void FilterRow(const Rows& rows, int width, bool largest, std::uint8_t* out);

  Plane brightest_;  // largest value of the square around each pixel
  Plane darkest_;
  Plane column_;  // extremes of the columns of a row of squares, with kReach more at both ends
  Plane light_;   // light of a row
  Thresholds row_;
};

}  // namespace kestrel
