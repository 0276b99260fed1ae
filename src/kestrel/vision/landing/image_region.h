// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace kestrel {

// A part of the camera's image at 1 / 2^level of its resolution.
struct ImageRegion {
  cv::Point offset{0, 0};  // its first pixel, at full resolution
  int level = 0;

  double scale() const { return 1 << level; }
  Eigen::Vector2d FromFull(const Eigen::Vector2d& pixel) const {
    return ((pixel - Eigen::Vector2d(offset.x, offset.y)).array() + 0.5) / scale() - 0.5;
  }
  Eigen::Vector2d ToFull(const Eigen::Vector2d& pixel) const {
    return (((pixel.array() + 0.5) * scale() - 0.5).matrix() + Eigen::Vector2d(offset.x, offset.y));
  }
};

}  // namespace kestrel
