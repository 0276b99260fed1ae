// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/region/background_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

constexpr int kSide = 64;
constexpr int kSamples = 4;  // pixels read of a cell, along each axis

}  // namespace

BackgroundMotion::BackgroundMotion()
    : transform_(kSide, 2),
      grid_(kSide, 2),
      current_(kSide, 2),
      previous_(kSide, 2),
      cross_(kSide, 2),
      taper_(kSide) {
  for (int i = 0; i < kSide; ++i) taper_[i] = static_cast<float>(std::sin(kPi * (i + 0.5) / kSide));
}

// The green of a colour image is its gray about.
void BackgroundMotion::Shrink(const cv::Mat& image) {
  const int channels = image.channels(), channel = channels / 2;
  constexpr int kAcross = kSide * kSamples;
  std::array<int, kAcross> offsets;
  for (int i = 0; i < kAcross; ++i) {
    offsets[i] = (2 * i + 1) * image.cols / (2 * kAcross) * channels + channel;
  }
  for (int y = 0; y < kSide; ++y) {
    std::array<float, kSide> sums{};
    for (int k = 0; k < kSamples; ++k) {
      const int row = (2 * (y * kSamples + k) + 1) * image.rows / (2 * kAcross);
      const std::uint8_t* pixels = image.ptr<std::uint8_t>(row);
      for (int i = 0; i < kAcross; ++i) sums[i / kSamples] += pixels[offsets[i]];
    }
    for (int x = 0; x < kSide; ++x) {
      grid_.Cell(x, y)[0] = sums[x];
      grid_.Cell(x, y)[1] = 0;
    }
  }
  float mean = 0;
  for (int i = 0; i < kSide * kSide; ++i) mean += grid_.values[2 * i] / (kSide * kSide);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      float& value = grid_.Cell(x, y)[0];
      value = (value - mean) * taper_[x] * taper_[y];
    }
  }
}

Eigen::Vector2d BackgroundMotion::Update(const cv::Mat& image) {
  constexpr double kLeastPeak = 0.08;  // where 1 is a shift without any change
  const bool is_first = image.size() != size_;
  size_ = image.size();
  Shrink(image);
  std::swap(previous_, current_);
  transform_.Forward(&grid_, &current_);
  if (is_first) return Eigen::Vector2d::Zero();
  for (int bin = 0; bin < current_.bins(); ++bin) {
    const float* a = current_.Bin(bin);
    const float* b = previous_.Bin(bin);
    const float re = a[0] * b[0] + a[2] * b[2], im = a[2] * b[0] - a[0] * b[2];
    const float inverse = 1 / (std::sqrt(re * re + im * im) + 1e-3f);
    cross_.Bin(bin)[0] = re * inverse;
    cross_.Bin(bin)[2] = im * inverse;
  }
  transform_.Inverse(cross_, &grid_);
  int best = 0;
  for (int i = 1; i < kSide * kSide; ++i) {
    if (grid_.values[2 * i] > grid_.values[2 * best]) best = i;
  }
  const int x = best % kSide, y = best / kSide;
  // The centroid of the peak and its neighbours.
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double total = 0;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const double value =
          std::max(0.0f, grid_.Cell((x + dx + kSide) % kSide, (y + dy + kSide) % kSide)[0]);
      sum += value * Eigen::Vector2d(dx, dy);
      total += value;
    }
  }
  if (total < kLeastPeak) return Eigen::Vector2d::Zero();
  const Eigen::Vector2d shift =
      Eigen::Vector2d(x < kSide / 2 ? x : x - kSide, y < kSide / 2 ? y : y - kSide) + sum / total;
  return shift.cwiseProduct(Eigen::Vector2d(image.cols, image.rows)) / kSide;
}

}  // namespace kestrel
