// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/helipad/narrow_borders.h"

#include <array>
#include <cmath>

#include "kestrel/vision/helipad/log_gray.h"

namespace kestrel {
namespace {

using GrayTable = std::array<std::uint8_t, 256>;

// Logarithms of gray values, 0 to 255, of a print whose ink is dark.
GrayTable TableOf(bool white_ink) {
  const LogGrays log;
  GrayTable table;
  for (int gray = 0; gray < 256; ++gray) {
    const float share = log(static_cast<float>(gray));
    table[gray] = static_cast<std::uint8_t>(std::lround(255 * (white_ink ? 1 - share : share)));
  }
  return table;
}

}  // namespace

void NarrowBorderBuffers::Reserve(const cv::Mat& image, BorderBuffers* borders) {
  gray.resize(image.total());
  top_hat.Binarize(image, 1, &borders->binary);
}

std::span<const Border> TraceNarrow(int level, bool white_ink, const BorderLimits& limits,
                                    BorderBuffers* borders, NarrowBorderBuffers* buffers) {
  static const GrayTable kBlackInk = TableOf(false), kWhiteInk = TableOf(true);
  constexpr int kLeastContrast = 16;  // of 255
  const cv::Mat image = borders->pyramid.ImageAt(level);
  if (image.empty()) return {};
  const GrayTable& table = white_ink ? kWhiteInk : kBlackInk;
  cv::Mat gray(image.size(), CV_8UC1, buffers->gray.data());
  for (int y = 0; y < image.rows; ++y) {
    const std::uint8_t* const from = image.ptr(y);
    std::uint8_t* const to = gray.ptr(y);
    for (int x = 0; x < image.cols; ++x) to[x] = table[from[x]];
  }
  buffers->top_hat.Binarize(gray, kLeastContrast, &borders->binary);
  borders->tracer.Trace(borders->binary, cv::Rect(0, 0, image.cols, image.rows), limits);
  return borders->tracer.borders();
}

}  // namespace kestrel
