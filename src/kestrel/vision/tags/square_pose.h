// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

#include "kestrel/core/geometry/rigid_transform.h"

namespace kestrel {

// Unit rays to the corners of a square, clockwise as it is seen on its face: the first is its upper
// left one. The square has side 1, its frame the origin in its middle, x to the right and y up.
using SquareCorners = std::array<Eigen::Vector3d, 4>;

// Returns the homography from the square to its rays: the point (x, y) is seen along H (x, y, 1).
// Nothing when no square looks like this.
std::optional<Eigen::Matrix3d> HomographyOfSquare(const SquareCorners& corners);

// Returns the pose of the square whose corners are nearest to the rays, nothing when they are those
// of its back. Of the two poses under which a far square looks nearly the same it is the likelier.
std::optional<RigidTransform> PoseOfSquare(const SquareCorners& corners,
                                           const Eigen::Matrix3d& homography);

}  // namespace kestrel
