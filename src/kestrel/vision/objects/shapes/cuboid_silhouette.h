// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <span>

#include <Eigen/Core>

namespace kestrel {

// Silhouette of a cuboid on the horizontal plane at unit distance below the camera. The origin of
// the plane is directly below the camera.
struct CuboidSilhouette {
  std::span<const Eigen::Vector2d> outline;         // points on its border, in any order
  std::span<const Eigen::Vector2d> cut;             // points where the image border cuts it off
  Eigen::Vector2d digit = Eigen::Vector2d::Zero();  // approximate middle of the digit
  double height_by_side = 1;        // height of the cuboid by the side of its upper face
  std::optional<double> half_side;  // half the side of its upper face, where known
};

// Corners of the upper face on the plane, in order around it, and the root mean square distance
// between the silhouette and that of the cuboid, as a share of half a side.
struct CuboidFit {
  std::array<Eigen::Vector2d, 4> corners;
  double residual = 0;
};

// Fits an upright cuboid with a square upper face. On the plane, its upper face is a square, and
// the lower face is the same square scaled towards the origin. The silhouette is the convex hull of
// both, or less where a side face is too dark to have a colour. Side faces as bright as the upper
// face are harmless, because no edge between them is needed. Returns nothing when less than half of
// the silhouette's extents are in view.
std::optional<CuboidFit> FitCuboid(const CuboidSilhouette& silhouette);

}  // namespace kestrel
