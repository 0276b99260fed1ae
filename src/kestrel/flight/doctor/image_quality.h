// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include <opencv2/core.hpp>

namespace kestrel {

// Focus and exposure of an image, and a hash that detects repeated images.
struct ImageQuality {
  double mean_gray = 0;
  double bright_gray = 0;      // 1 % of the pixels are brighter
  double dark_gray = 0;        // 1 % are darker
  double saturated_share = 0;  // share of pixels at 250 and above
  // Width of the sharpest edges in pixels: 1 without blur, 2.5 standard deviations of a blur.
  // Nothing where there are too few edges.
  std::optional<double> edge_px;
  std::uint64_t hash = 0;  // see RepeatedImage
};

// 'image': CV_8UC1 or CV_8UC3.
ImageQuality MeasureImageQuality(const cv::Mat& image);

}  // namespace kestrel
