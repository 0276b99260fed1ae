// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/search/threshold_view.h"

#include <algorithm>
#include <cstdint>

#include "kestrel/vision/landing/search/search_plan.h"
#include "kestrel/vision/landing/search/searched_image.h"

namespace kestrel {
namespace {

constexpr std::uint8_t kDark = 0, kUndecided = 128, kBright = 255;

const SearchPass& FirstPass(int level) {
  return *std::find_if(kPasses.begin(), kPasses.end(), [&](const SearchPass& pass) {
    // A pass with another definition of dark would represent the threshold less well.
    const bool is_plain = !pass.black && !pass.top_hat && !pass.not_bright;
    return pass.image_level == level && is_plain;
  });
}

}  // namespace

ThresholdView::ThresholdView() : buffers_(std::make_unique<SearchedImageBuffers>()) {}
ThresholdView::~ThresholdView() = default;

cv::Mat ThresholdView::Draw(const cv::Mat& image, int level) {
  if (image.empty() || image.type() != CV_8UC1) return {};
  buffers_->pyramid.Build(image);
  Binarize(FirstPass(level), buffers_.get());
  const BitImage& dark = buffers_->binary.dark;
  const BitImage& bright = buffers_->binary.bright;
  // Pixels at the right and lower border that the lower resolution lacks stay undecided.
  cv::Mat view(image.size(), CV_8UC1, cv::Scalar(kUndecided));
  for (int v = 0; v < view.rows && v >> level < dark.height(); ++v) {
    auto* const pixel = view.ptr<std::uint8_t>(v);
    for (int u = 0; u < view.cols && u >> level < dark.width(); ++u) {
      if (dark.at(u >> level, v >> level)) pixel[u] = kDark;
      if (bright.at(u >> level, v >> level)) pixel[u] = kBright;
    }
  }
  return view;
}

}  // namespace kestrel
