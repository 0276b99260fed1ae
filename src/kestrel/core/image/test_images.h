// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include <opencv2/core.hpp>

#include "kestrel/core/base/random.h"

namespace kestrel {

// An image in its own memory of exactly its bytes, so that a sanitizer detects every read beyond
// them. 'stride' in bytes; the memory ends with the last pixel of the last row.
struct ExactImage {
  ExactImage(int width, int height, int stride)
      : bytes(new std::uint8_t[static_cast<std::size_t>(stride) * (height - 1) + width]),
        image(height, width, CV_8UC1, bytes.get(), stride) {}
  std::unique_ptr<std::uint8_t[]> bytes;
  cv::Mat image;
};

// Blobs and noise of all contrasts, including black and white.
inline ExactImage RandomImage(int width, int height, int stride, Random* random) {
  ExactImage exact(width, height, stride);
  std::array<int, 4> level;
  for (int& gray : level) gray = random->Integer(0, 255);
  const int noise = random->Chance(0.3) ? 0 : random->Integer(1, 40);
  const int blob = random->Integer(3, 40);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int gray = level[(x / blob + 2 * (y / blob)) % 4] + random->Integer(-noise, noise);
      exact.image.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(std::clamp(gray, 0, 255));
    }
  }
  return exact;
}

}  // namespace kestrel
