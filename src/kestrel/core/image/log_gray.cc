// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/image/log_gray.h"

#include <algorithm>

namespace kestrel {
namespace {

using GrayTable = std::array<std::uint8_t, 256>;

GrayTable MakeTable() {
  const LogGrays log;
  GrayTable table;
  for (int gray = 0; gray < 256; ++gray) {
    table[gray] = static_cast<std::uint8_t>(std::lround(255 * log(static_cast<float>(gray))));
  }
  return table;
}

}  // namespace

cv::Mat WriteLogGrays(const cv::Mat& image, std::uint8_t* log_grays) {
  static const GrayTable kTable = MakeTable();
  cv::Mat log(image.size(), CV_8UC1, log_grays);
  for (int y = 0; y < image.rows; ++y) {
    const std::uint8_t* const from = image.ptr(y);
    std::transform(from, from + image.cols, log.ptr(y),
                   [](std::uint8_t gray) { return kTable[gray]; });
  }
  return log;
}

}  // namespace kestrel
