// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/helipad/narrow_borders.h"

#include <algorithm>

namespace kestrel {
namespace {

cv::Mat Inverted(const cv::Mat& image, std::vector<std::uint8_t>* memory) {
  cv::Mat inverted(image.size(), CV_8UC1, memory->data());
  for (int y = 0; y < image.rows; ++y) {
    const std::uint8_t* const from = image.ptr(y);
    std::transform(from, from + image.cols, inverted.ptr(y),
                   [](std::uint8_t gray) { return static_cast<std::uint8_t>(255 - gray); });
  }
  return inverted;
}

}  // namespace

void NarrowBorderBuffers::Reserve(const cv::Mat& image, BorderBuffers* borders) {
  inverted.resize(image.total());
  top_hat.Binarize(image, 1, &borders->binary);
}

std::span<const Border> TraceNarrow(int level, bool white_ink, const BorderLimits& limits,
                                    BorderBuffers* borders, NarrowBorderBuffers* buffers) {
  constexpr int kLeastContrast = 16;  // of 255
  const cv::Mat image = borders->pyramid.ImageAt(level);
  if (image.empty()) return {};
  buffers->top_hat.Binarize(white_ink ? Inverted(image, &buffers->inverted) : image, kLeastContrast,
                            &borders->binary);
  borders->tracer.Trace(borders->binary, cv::Rect(0, 0, image.cols, image.rows), limits);
  return borders->tracer.borders();
}

}  // namespace kestrel
