// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include <Eigen/Core>

#include "kestrel/core/image/border_tracing.h"

namespace kestrel {

// The convex hull of a border, which may cross itself and run in either direction. Uses no heap
// memory.
class ConvexHull {
 public:
  // Largest height of a border. Points below it are ignored.
  static constexpr int kMaxHeight = 63;  // pixels

  using Points = std::span<const GridPoint>;

  // 'points': at least one.
  explicit ConvexHull(Points points);

  // Corners, clockwise in the image, in pixels, integer = centre of a pixel. The uppermost and the
  // lowest one occur twice where they are points and not sides.
  std::span<const Eigen::Vector2d> corners() const { return {corners_.data(), count_}; }

 private:
  void Append(const Eigen::Vector2d& point, std::size_t first);

  std::array<Eigen::Vector2d, 2 * (kMaxHeight + 1)> corners_;  // room for two vertices per row
  std::size_t count_ = 0;
};

}  // namespace kestrel
