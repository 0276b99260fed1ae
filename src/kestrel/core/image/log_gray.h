// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include <opencv2/core.hpp>

namespace kestrel {

// Logarithms of gray values, from 0 to 1. A shadow divides the light; what it takes from a
// logarithm is the same on black and on white, so that the contrast of a print stays.
class LogGrays {
 public:
  LogGrays() {
    constexpr double kDarkest = 8;  // below it is mostly noise and stray light
    for (int gray = 0; gray < 256; ++gray) {
      values_[gray] = static_cast<float>(std::log1p(gray / kDarkest) / std::log1p(255 / kDarkest));
    }
  }
  // 'gray': 0 to 255, rounded down.
  float operator()(float gray) const { return values_[static_cast<int>(gray)]; }

 private:
  std::array<float, 256> values_;
};

// Writes the logarithms of an image, 0 to 255, to as many bytes as it has pixels, row by row, and
// returns them as an image. 'image': CV_8UC1.
cv::Mat WriteLogGrays(const cv::Mat& image, std::uint8_t* log_grays);

}  // namespace kestrel
