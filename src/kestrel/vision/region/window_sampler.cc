// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/region/window_sampler.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kestrel/vision/region/window_sampler.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h, which includes this file once for every instruction set.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace kestrel {
namespace HWY_NAMESPACE {

void AddWeighted(const std::uint8_t* HWY_RESTRICT from, float weight, int count,
                 float* HWY_RESTRICT sum) {
  for (int i = 0; i < count; ++i) sum[i] += weight * static_cast<float>(from[i]);
}

}  // namespace HWY_NAMESPACE
}  // namespace kestrel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace kestrel {

HWY_EXPORT(AddWeighted);

void WindowSampler::Axis::Fill(int side, double center_px, double size_px, int limit) {
  const double step = size_px / side;
  const double radius = std::max(1.0, step);
  taps.resize(side);
  weights.clear();
  for (int i = 0; i < side; ++i) {
    const double at = center_px + (i - 0.5 * (side - 1)) * step;
    const int first = static_cast<int>(std::ceil(at - radius));
    const int last = static_cast<int>(std::floor(at + radius));
    Taps& tap = taps[i];
    tap.first = std::clamp(first, 0, limit - 1);
    tap.count = std::clamp(last, 0, limit - 1) - tap.first + 1;
    tap.first_weight = weights.size();
    weights.resize(weights.size() + tap.count, 0.0f);
    double sum = 0;
    for (int k = first; k <= last; ++k) sum += radius - std::abs(k - at);
    for (int k = first; k <= last; ++k) {
      weights[tap.first_weight + std::clamp(k, 0, limit - 1) - tap.first] +=
          static_cast<float>((radius - std::abs(k - at)) / sum);
    }
  }
}

void WindowSampler::Reserve(const cv::Size& image_size, int channels) {
  // Each pixel of the image is in at most two triangles; an enlarged part has two taps a pixel.
  constexpr std::size_t kMostSide = 1024;
  row_.reserve(std::size_t(image_size.width) * channels + 1);
  columns_.taps.reserve(kMostSide);
  rows_.taps.reserve(kMostSide);
  columns_.weights.reserve(2 * image_size.width + 4 * kMostSide);
  rows_.weights.reserve(2 * image_size.height + 4 * kMostSide);
}

template <int channels>
void WindowSampler::SampleRow(int first, int y, SampledWindow* window) const {
  using Values = Eigen::Array<float, channels == 3 ? 4 : channels, 1>;  // 4 fill a register
  for (int x = 0; x < window->side; ++x) {
    const Taps& taps = columns_.taps[x];
    const float* from = &row_[std::size_t(taps.first - first) * channels];
    const float* weights = &columns_.weights[taps.first_weight];
    Values sum = Values::Zero();
    for (int k = 0; k < taps.count; ++k, from += channels) {
      sum += weights[k] * Eigen::Map<const Values>(from);
    }
    for (int c = 0; c < channels; ++c)
      window->values[c][std::size_t(y) * window->side + x] = sum[c];
  }
}

void WindowSampler::Sample(const cv::Mat& image, const Eigen::Vector2d& center_px,
                           const Eigen::Vector2d& size_px, SampledWindow* window) {
  const int side = window->side, channels = image.channels();
  columns_.Fill(side, center_px.x(), size_px.x(), image.cols);
  rows_.Fill(side, center_px.y(), size_px.y(), image.rows);
  const int first = columns_.taps.front().first;
  const int last = columns_.taps.back().first + columns_.taps.back().count;
  const int count = (last - first) * channels;
  row_.resize(count + 1);
  for (int y = 0; y < side; ++y) {
    std::fill(row_.begin(), row_.end(), 0.0f);
    const Taps& rows = rows_.taps[y];
    for (int k = 0; k < rows.count; ++k) {
      HWY_DYNAMIC_DISPATCH(AddWeighted)
      (image.ptr<std::uint8_t>(rows.first + k) + first * channels,
       rows_.weights[rows.first_weight + k], count, row_.data());
    }
    if (channels == 3) {
      SampleRow<3>(first, y, window);
    } else {
      SampleRow<1>(first, y, window);
    }
  }
}

}  // namespace kestrel
#endif  // HWY_ONCE
