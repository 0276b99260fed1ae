// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/location/pattern_view.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kestrel/core/image/gray_sampling.h"

namespace kestrel {

PatternView::PatternView(const CameraModel& camera, const RigidTransform& camera_from_target,
                         double extent_m, const ImageRegion& region)
    : PatternView(PlaneWarp(camera, camera_from_target, extent_m), extent_m, region) {}

PatternView::PatternView(const PlaneWarp& warp, double extent_m, const ImageRegion& region)
    : warp_(warp), region_(region) {
  constexpr int kNodes = 4;
  std::array<float, kNodes * kNodes> x_m, y_m, x_px, y_px;
  for (int i = 0; i < kNodes * kNodes; ++i) {
    const int row = i / kNodes, column = i % kNodes;
    x_m[i] = static_cast<float>(extent_m * (2.0 * column / (kNodes - 1) - 1));
    y_m[i] = static_cast<float>(extent_m * (2.0 * row / (kNodes - 1) - 1));
  }
  warp.ProjectMany(x_m.data(), y_m.data(), x_m.size(), x_px.data(), y_px.data());
  valid_ = std::none_of(x_px.begin(), x_px.end(), [](float x) { return std::isnan(x); });
}

void PatternView::Project(const float* x_m, const float* y_m, std::size_t count, float* x_px,
                          float* y_px) const {
  warp_.ProjectMany(x_m, y_m, count, x_px, y_px);
  const auto scale = static_cast<float>(1 / region_.scale());
  const Eigen::Vector2f first = region_.FromFull(Eigen::Vector2d::Zero()).cast<float>();
  for (std::size_t i = 0; i < count; ++i) x_px[i] = scale * x_px[i] + first.x();
  for (std::size_t i = 0; i < count; ++i) y_px[i] = scale * y_px[i] + first.y();
}

void PatternView::Sample(const cv::Mat& image, const float* x_m, const float* y_m,
                         std::size_t count, float* gray) const {
  constexpr std::size_t kBlock = 64;
  std::array<float, kBlock> x_px, y_px;
  for (std::size_t i = 0; i < count; i += kBlock) {
    const std::size_t block = std::min(kBlock, count - i);
    Project(x_m + i, y_m + i, block, x_px.data(), y_px.data());
    SampleGrays(image, x_px.data(), y_px.data(), block, gray + i);
  }
}

}  // namespace kestrel
