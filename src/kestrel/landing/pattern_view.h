// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/camera/camera_model.h"
#include "kestrel/geometry/rigid_transform.h"

namespace kestrel {

// Gray value of a CV_8UC1 image between its pixels, bilinear; the point must lie in the image.
inline float SampleInside(const cv::Mat& image, float x, float y) {
  const int x0 = std::min(static_cast<int>(x), image.cols - 2);
  const int y0 = std::min(static_cast<int>(y), image.rows - 2);
  const float fx = x - static_cast<float>(x0);
  const float fy = y - static_cast<float>(y0);
  const std::uint8_t* upper = image.data + image.step[0] * y0 + x0;
  const std::uint8_t* lower = upper + image.step[0];
  const float top = upper[0] + fx * static_cast<float>(upper[1] - upper[0]);
  const float bottom = lower[0] + fx * static_cast<float>(lower[1] - lower[0]);
  return top + fy * (bottom - top);
}

// The same; negative outside of the image.
inline float SampleGray(const cv::Mat& image, float x, float y) {
  const bool inside = x >= 0 && y >= 0 && x <= static_cast<float>(image.cols - 1) &&
                      y <= static_cast<float>(image.rows - 1);
  return inside ? SampleInside(image, x, y) : -1;
}

// A part of the camera's image at 1 / 2^level of its resolution.
struct ImageRegion {
  cv::Point offset{0, 0};  // of its first pixel, at full resolution
  int level = 0;

  double scale() const { return 1 << level; }
  Eigen::Vector2d FromFull(const Eigen::Vector2d& pixel) const {
    return ((pixel - Eigen::Vector2d(offset.x, offset.y)).array() + 0.5) / scale() - 0.5;
  }
  Eigen::Vector2d ToFull(const Eigen::Vector2d& pixel) const {
    return (((pixel.array() + 0.5) * scale() - 0.5).matrix() + Eigen::Vector2d(offset.x, offset.y));
  }
};

// The plane of the pattern as an image shows it under an assumed pose: pattern coordinates to
// pixels. Projects the nodes of a grid exactly and interpolates between them, because a candidate
// is looked at in many more places than it is worth projecting.
class PatternView {
 private:
  static constexpr int kNodes = 9;

  // Node before a place, and how far the place is beyond it.
  struct Cell {
    explicit Cell(float place)
        : node(std::clamp(static_cast<int>(place), 0, kNodes - 2)),
          share(place - static_cast<float>(node)) {}
    int node;
    float share;
  };

 public:
  // Covers |x|, |y| <= 'extent_m' of the plane. Pixels are those of 'region'.
  PatternView(const CameraModel& camera, const RigidTransform& camera_from_pattern, double extent_m,
              const ImageRegion& region);

  // False when the lens model does not show the whole extent.
  bool valid() const { return valid_; }

  // A line of the plane along x: for many points of it.
  class Row {
   public:
    Eigen::Vector2f Pixel(float x_m) const {
      const Cell cell((x_m + extent_m_) * nodes_per_m_);
      return nodes_[cell.node] + cell.share * (nodes_[cell.node + 1] - nodes_[cell.node]);
    }

   private:
    friend class PatternView;
    Row(float extent_m, float nodes_per_m) : extent_m_(extent_m), nodes_per_m_(nodes_per_m) {}
    float extent_m_;
    float nodes_per_m_;
    std::array<Eigen::Vector2f, kNodes> nodes_;
  };
  Row RowAt(float y_m) const {
    Row row(extent_m_, nodes_per_m_);
    const Cell cell((y_m + extent_m_) * nodes_per_m_);
    const Eigen::Vector2f* upper = &nodes_[cell.node * kNodes];
    for (int i = 0; i < kNodes; ++i) {
      row.nodes_[i] = upper[i] + cell.share * (upper[kNodes + i] - upper[i]);
    }
    return row;
  }

  // Pixel of a point of the plane (m), which must lie within the extent.
  Eigen::Vector2f Pixel(float x_m, float y_m) const {
    const Cell x((x_m + extent_m_) * nodes_per_m_);
    const Cell y((y_m + extent_m_) * nodes_per_m_);
    const Eigen::Vector2f* node = &nodes_[y.node * kNodes + x.node];
    const Eigen::Vector2f upper = node[0] + x.share * (node[1] - node[0]);
    const Eigen::Vector2f lower = node[kNodes] + x.share * (node[kNodes + 1] - node[kNodes]);
    return upper + y.share * (lower - upper);
  }

  // Gray value at a point of the plane; negative where the image does not show it.
  float Sample(const cv::Mat& image, float x_m, float y_m) const {
    const Eigen::Vector2f pixel = Pixel(x_m, y_m);
    return SampleGray(image, pixel.x(), pixel.y());
  }

 private:
  float extent_m_;
  float nodes_per_m_;
  bool valid_ = true;
  std::array<Eigen::Vector2f, kNodes * kNodes> nodes_;
};

}  // namespace kestrel
