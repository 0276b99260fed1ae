// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "kestrel/core/base/time.h"

namespace kestrel {

// The path of a target that nobody knows, as something that measured positions either fit or do
// not: a point where it stands, a smooth curve (uniform cubic B-spline) where it moves.
class TargetPath {
 public:
  // 'times' in order, at least one; 'weights': reciprocal standard deviations, one for each.
  // 'knot_spacing_s': 0 for a target that stands, else the time between the knots of its curve.
  TargetPath(const std::vector<Time>& times, const Eigen::VectorXd& weights, double knot_spacing_s);

  // Number of unknowns of the path per coordinate.
  Eigen::Index size() const { return basis_.cols(); }

  // What is left of 'positions' (a row for each time), weighted, after the path that fits them best
  // in the sense of least squares.
  Eigen::MatrixX3d Residuals(const Eigen::MatrixX3d& positions) const;

 private:
  Eigen::VectorXd weights_;
  Eigen::MatrixXd basis_;  // orthonormal columns that span the weighted paths
};

}  // namespace kestrel
