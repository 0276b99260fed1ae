// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include <Eigen/Core>

#include "kestrel/core/image/border_tracing.h"

namespace kestrel {

// The convex hull of a border, which may cross itself and run either way. Needs no memory of the
// heap.
class ConvexHull {
 public:
  // The tallest border that it takes: what lies below is left out.
  static constexpr int kMaxHeight = 63;  // pixels

  using Points = std::span<const GridPoint>;

  // Of at least one point.
  explicit ConvexHull(Points points);

  // Clockwise in the image, in pixels, integer = centre of a pixel. The uppermost and the lowest
  // one come twice where they are points and no sides.
  std::span<const Eigen::Vector2d> corners() const { return {corners_.data(), count_}; }

 private:
  void Append(const Eigen::Vector2d& point, std::size_t first);

  std::array<Eigen::Vector2d, 2 * (kMaxHeight + 1)> corners_;  // those of two vertices a row
  std::size_t count_ = 0;
};

}  // namespace kestrel
