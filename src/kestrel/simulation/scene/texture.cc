// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/scene/texture.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <opencv2/imgproc.hpp>

namespace kestrel {
namespace {

std::array<float, 256> MakeReflectances() {
  std::array<float, 256> reflectances{};
  for (int code = 0; code < 256; ++code) {
    reflectances[code] = static_cast<float>(code * code) / (255.0f * 255.0f);
  }
  return reflectances;
}

// Returns the image at half the width and height; a side of one pixel stays.
cv::Mat Halve(const cv::Mat& codes) {
  cv::Mat half((codes.rows + 1) / 2, (codes.cols + 1) / 2, codes.type());
  const int channels = codes.channels();
  for (int v = 0; v < half.rows; ++v) {
    const auto* upper = codes.ptr<std::uint8_t>(2 * v);
    const auto* lower = codes.ptr<std::uint8_t>(std::min(2 * v + 1, codes.rows - 1));
    auto* out = half.ptr<std::uint8_t>(v);
    for (int u = 0; u < half.cols; ++u) {
      const int x0 = channels * 2 * u;
      const int x1 = channels * std::min(2 * u + 1, codes.cols - 1);
      for (int c = 0; c < channels; ++c) {
        const float sum = kReflectanceOfCode[upper[x0 + c]] + kReflectanceOfCode[upper[x1 + c]] +
                          kReflectanceOfCode[lower[x0 + c]] + kReflectanceOfCode[lower[x1 + c]];
        out[channels * u + c] =
            static_cast<std::uint8_t>(std::lround(255 * std::sqrt(0.25f * sum)));
      }
    }
  }
  return half;
}

cv::Mat WithChannels(const cv::Mat& codes, int channels) {
  if (codes.channels() == channels) return codes;
  cv::Mat converted;
  cv::cvtColor(codes, converted, channels == 1 ? cv::COLOR_BGR2GRAY : cv::COLOR_GRAY2BGR);
  return converted;
}

}  // namespace

const std::array<float, 256> kReflectanceOfCode = MakeReflectances();

std::uint8_t CodeOfReflectance(double reflectance) {
  return cv::saturate_cast<std::uint8_t>(255 * std::sqrt(std::max(reflectance, 0.0)));
}

Texture::Texture(const cv::Mat& codes, int channels, Beyond beyond)
    : channels_(channels), beyond_(beyond) {
  cv::Mat level = WithChannels(codes, channels);
  while (true) {
    const cv::Mat row = level.isContinuous() ? level : level.clone();
    const std::size_t size = row.total() * row.elemSize();
    levels_.push_back({row.cols, row.rows, std::vector<std::uint8_t>(row.data, row.data + size)});
    if (level.cols == 1 && level.rows == 1) break;
    level = Halve(level);
  }
}

int Texture::LevelOf(float footprint) const {
  if (!(footprint > 1)) return 0;
  const int level = static_cast<int>(std::lround(std::log2(footprint)));
  return std::min(level, static_cast<int>(levels_.size()) - 1);
}

}  // namespace kestrel
