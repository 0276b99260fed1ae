// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace kestrel {

// Paint is stored in 8 bits as the square root of its reflectance: the steps are as fine in the
// dark as in the light. 'reflectance' is 0 to 1.
std::uint8_t CodeOfReflectance(double reflectance);

// Light of one channel (gray) or three (blue, green, red).
template <int kChannels>
using Light = Eigen::Array<float, kChannels, 1>;

// An image painted on a surface, with smaller copies of itself (mip levels) for views from afar.
// Immutable, thread-safe.
class Texture {
 public:
  // Continuation beyond the edge: the last row or column, the image again, or its mirror image.
  enum class Beyond { kClamp, kRepeat, kMirror };

  // 'codes': CV_8UC1 or CV_8UC3 of CodeOfReflectance, at least 1 px; kRepeat and kMirror need sides
  // that are powers of two. 'channels': 1 or 3, as Sample will request.
  Texture(const cv::Mat& codes, int channels, Beyond beyond = Beyond::kClamp);

  int channels() const { return channels_; }
  int width_px() const { return levels_.front().width; }
  int height_px() const { return levels_.front().height; }

  // Returns the level whose pixels are about as large as 'footprint', in pixels of the full image.
  int LevelOf(float footprint) const;

  // Returns the reflectance at (x, y) px of the full image, whose upper left corner (not pixel
  // centre) is (0, 0); bilinear within 'level'.
  template <int kChannels>
  Light<kChannels> Sample(float x, float y, int level) const;

 private:
  struct Level {
    int width;
    int height;
    std::vector<std::uint8_t> codes;
  };
  static int Fold(int i, int size, Beyond beyond);
  static int RoundDown(float x) {
    const int whole = static_cast<int>(x);
    return static_cast<float>(whole) > x ? whole - 1 : whole;
  }

  std::vector<Level> levels_;
  int channels_;
  Beyond beyond_;
};

// Reflectance of all codes.
extern const std::array<float, 256> kReflectanceOfCode;

inline int Texture::Fold(int i, int size, Beyond beyond) {
  if (static_cast<unsigned>(i) < static_cast<unsigned>(size)) return i;
  switch (beyond) {
    case Beyond::kRepeat:
      return i & (size - 1);
    case Beyond::kMirror:
      i &= 2 * size - 1;
      return i < size ? i : 2 * size - 1 - i;
    default:
      return i < 0 ? 0 : size - 1;
  }
}

template <int kChannels>
Light<kChannels> Texture::Sample(float x, float y, int level) const {
  const Level& image = levels_[level];
  const float scale = 1.0f / static_cast<float>(1 << level);
  const float column = x * scale - 0.5f;
  const float row = y * scale - 0.5f;
  const int left = RoundDown(column);
  const int top = RoundDown(row);
  const float right_part = column - static_cast<float>(left);
  const float lower_part = row - static_cast<float>(top);
  const int x0 = kChannels * Fold(left, image.width, beyond_);
  const int x1 = kChannels * Fold(left + 1, image.width, beyond_);
  const std::ptrdiff_t stride = kChannels * static_cast<std::ptrdiff_t>(image.width);
  const std::uint8_t* upper = image.codes.data() + stride * Fold(top, image.height, beyond_);
  const std::uint8_t* lower = image.codes.data() + stride * Fold(top + 1, image.height, beyond_);
  Light<kChannels> light;
  for (int c = 0; c < kChannels; ++c) {
    const float above = kReflectanceOfCode[upper[x0 + c]] * (1 - right_part) +
                        kReflectanceOfCode[upper[x1 + c]] * right_part;
    const float below = kReflectanceOfCode[lower[x0 + c]] * (1 - right_part) +
                        kReflectanceOfCode[lower[x1 + c]] * right_part;
    light[c] = above + lower_part * (below - above);
  }
  return light;
}

}  // namespace kestrel
