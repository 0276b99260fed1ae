// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include <Eigen/Core>

#include "kestrel/core/geometry/rigid_transform.h"

namespace kestrel {

// Area and second moments of a plane figure about its centroid.
struct FigureMoments {
  double area = 0;  // area, with a sign by the direction of the border
  Eigen::Vector2d centroid = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();

  // The same for all affine images of a figure: 1 for an ellipse, less for what is less compact.
  double Compactness() const;
};

FigureMoments MomentsOf(std::span<const Eigen::Vector2d> corners);

// Returns one of the two poses of a small plane figure by the affine map from its plane to the
// image plane at distance 1 across the third of 'axes', with x and y along the others: place =
// 'map' (1 / m) * point + 'center'. 'sign', 1 or -1, chooses the pose.
RigidTransform PoseOfAffineMap(const Eigen::Matrix3d& axes, const Eigen::Matrix2d& map,
                               const Eigen::Vector2d& center, double sign);

}  // namespace kestrel
