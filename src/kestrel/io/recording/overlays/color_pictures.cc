// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/overlays/color_pictures.h"

#include <algorithm>
#include <cmath>

namespace kestrel {
namespace {

bool IsObject(ColorLabel label) { return label != kBackgroundLabel && label != kAmbiguousLabel; }

cv::Vec3b CellPixel(std::size_t cell) {
  const auto channel = [](std::size_t index) { return static_cast<uchar>(4 * index + 2); };
  return {channel(cell & 63), channel(cell >> 6 & 63), channel(cell >> 12)};
}

}  // namespace

cv::Mat DrawHueSaturation(const ColorGrid& grid) {
  constexpr int kWidth = 360;
  constexpr int kHeight = 200;
  constexpr int kReach = 2;  // a cell covers more than one pixel of the plane
  cv::Mat plane = cv::Mat::zeros(kHeight, kWidth, CV_8UC3);
  cv::Mat values = cv::Mat::zeros(kHeight, kWidth, CV_32FC1);
  for (std::size_t cell = 0; cell < ColorGrid::kCells; ++cell) {
    if (!IsObject(grid.labels()[cell])) continue;
    const Hsv color = ColorGrid::CellColor(cell);
    const int column = static_cast<int>(color.hue_deg);
    const int row = static_cast<int>(std::lround((1 - color.saturation) * (kHeight - 1)));
    for (int dv = -kReach; dv <= kReach; ++dv) {
      for (int du = -kReach; du <= kReach; ++du) {
        const int u = (column + du + kWidth) % kWidth;
        const int v = std::clamp(row + dv, 0, kHeight - 1);
        if (values.at<float>(v, u) >= color.value) continue;
        values.at<float>(v, u) = color.value;
        plane.at<cv::Vec3b>(v, u) = CellPixel(cell);
      }
    }
  }
  return plane;
}

cv::Mat DrawLabels(const cv::Mat& image, const ColorGrid& grid) {
  cv::Mat drawn = image.clone();
  for (int v = 0; v < drawn.rows; ++v) {
    for (int u = 0; u < drawn.cols; ++u) {
      auto& pixel = drawn.at<cv::Vec3b>(v, u);
      const ColorLabel label = grid.At(pixel.val);
      if (IsObject(label)) continue;
      const int sum = pixel[0] + pixel[1] + pixel[2];
      pixel = cv::Vec3b::all(static_cast<uchar>(label == kAmbiguousLabel ? sum / 4 : sum / 9));
    }
  }
  return drawn;
}

}  // namespace kestrel
