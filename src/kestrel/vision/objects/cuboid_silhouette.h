// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <span>

#include <Eigen/Core>

namespace kestrel {

// What is seen of a cuboid, on the horizontal plane at unit distance below the camera, whose origin
// is right below it.
struct CuboidSilhouette {
  std::span<const Eigen::Vector2d> outline;         // points on its border, in any order
  std::span<const Eigen::Vector2d> cut;             // where the image's border cuts it off
  Eigen::Vector2d digit = Eigen::Vector2d::Zero();  // where the middle of the digit is, about
  double height_by_side = 1;                        // of the cuboid
  std::optional<double> half_side;                  // of its upper face, as far as it is known
};

// Corners of the upper face on the plane, in the order of a walk around it, and how far the
// silhouette is from that of the cuboid (root of the mean square, share of half a side).
struct CuboidFit {
  std::array<Eigen::Vector2d, 4> corners;
  double residual = 0;
};

// Fits an upright cuboid with a square upper face. On the plane its upper face is a square, and the
// lower one the same square drawn nearer to the origin: the silhouette is the convex hull of both,
// or of less where a side face is too dark to have a colour. Side faces as bright as the upper one
// do no harm: no edge between them is needed. Nothing when less than half of its extents is seen.
std::optional<CuboidFit> FitCuboid(const CuboidSilhouette& silhouette);

}  // namespace kestrel
