// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/search/pad_samples.h"

#include <algorithm>
#include <array>

#include "kestrel/core/base/robust_statistics.h"
#include "kestrel/core/image/gray_sampling.h"

namespace kestrel {

void PadSamples::Reserve(std::size_t most) {
  for (std::vector<float>* column : {&x_, &y_, &z_, &u_, &v_, &moved_u_, &moved_v_, &gray_}) {
    if (column->size() < most) column->resize(most);
  }
}

void PadSamples::Add(const Eigen::Vector3d& point_in_camera) {
  x_[count_] = static_cast<float>(point_in_camera.x());
  y_[count_] = static_cast<float>(point_in_camera.y());
  z_[count_] = static_cast<float>(point_in_camera.z());
  ++count_;
}

void PadSamples::Project(const CameraModel& camera) {
  camera.ProjectMany({x_.data(), y_.data(), z_.data()}, count_, u_.data(), v_.data());
}

void PadSamples::Place(const CameraModel& camera, const RigidTransform& camera_from_pad,
                       std::span<const Eigen::Vector2d> places) {
  Clear();
  for (const Eigen::Vector2d& place : places) {
    Add(camera_from_pad * Eigen::Vector3d(place.x(), place.y(), 0));
  }
  Project(camera);
}

std::span<const float> PadSamples::Read(const cv::Mat& image, float dx, float dy) {
  for (std::size_t i = 0; i < count_; ++i) {
    moved_u_[i] = u_[i] + dx;
    moved_v_[i] = v_[i] + dy;
  }
  SampleGrays(image, moved_u_.data(), moved_v_.data(), count_, gray_.data());
  return {gray_.data(), count_};
}

// Replaces the gray value in the middle of each cell by the median over the middle and four places
// aside: a dot or a scratch on the print hides one place.
void PadSamples::TakeMedians(const cv::Mat& image, std::size_t grid_width) {
  constexpr float kAside = 0.25F;  // cells
  // From a cell to the next one of the row, or of the column.
  const auto step = [&](std::size_t i, std::size_t place, std::size_t stride) {
    const std::size_t before = place > 0 ? i - stride : i;
    const std::size_t after = place + 1 < grid_width ? i + stride : i;
    const float share = kAside * static_cast<float>(stride) / static_cast<float>(after - before);
    return std::pair(share * (u_[after] - u_[before]), share * (v_[after] - v_[before]));
  };
  for (std::size_t i = 0; i < count_; ++i) {
    if (gray_[i] < 0) continue;
    const auto [across_u, across_v] = step(i, i % grid_width, 1);
    const auto [down_u, down_v] = step(i, i / grid_width, grid_width);
    std::array grays{gray_[i], SampleGray(image, u_[i] + across_u, v_[i] + across_v),
                     SampleGray(image, u_[i] - across_u, v_[i] - across_v),
                     SampleGray(image, u_[i] + down_u, v_[i] + down_v),
                     SampleGray(image, u_[i] - down_u, v_[i] - down_v)};
    if (std::ranges::min(grays) >= 0) gray_[i] = MedianInPlace(grays);
  }
}

std::span<const float> PadSamples::ReadCells(const cv::Mat& image, int grid_width, double cell_px) {
  const std::span<const float> blurred = Read(image);
  constexpr double kWide = 6;  // px: so that the edges of a cell's neighbours blur no place of it
  if (cell_px >= kWide) TakeMedians(image, static_cast<std::size_t>(grid_width));
  // A blur by 'kBlurPx', undone to first order and then some: the series goes on.
  constexpr double kBlurPx = 0.8;
  constexpr double kMost = 0.5;
  const auto share = static_cast<float>(std::min(kMost, kBlurPx * kBlurPx / (cell_px * cell_px)));
  std::vector<float>& sharp = moved_u_;
  for (std::size_t i = 0; i < count_; ++i) {
    const int column = static_cast<int>(i) % grid_width;
    const int row = static_cast<int>(i) / grid_width;
    float excess = 0;  // over the neighbours
    const auto add = [&](int x, int y) {
      if (x < 0 || y < 0 || x >= grid_width || y >= grid_width) return;
      const float neighbor = blurred[y * grid_width + x];
      if (neighbor >= 0) excess += blurred[i] - neighbor;
    };
    add(column - 1, row);
    add(column + 1, row);
    add(column, row - 1);
    add(column, row + 1);
    sharp[i] = blurred[i] < 0 ? blurred[i] : std::max(0.0f, blurred[i] + share * excess);
  }
  return {sharp.data(), count_};
}

}  // namespace kestrel
