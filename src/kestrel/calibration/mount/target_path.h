// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "kestrel/core/base/time.h"

namespace kestrel {

// The unknown path of a target, as a linear model that measured positions fit or do not fit: a
// point if it stands, a smooth curve (uniform cubic B-spline) if it moves.
class TargetPath {
 public:
  // 'times': in order, at least one. 'weights': reciprocal standard deviations, one for each time.
  // 'knot_spacing_s': 0 for a target that stands, else the time between the knots of its curve.
  TargetPath(const std::vector<Time>& times, const Eigen::VectorXd& weights, double knot_spacing_s);

  // Number of the path's unknowns per coordinate.
  Eigen::Index size() const { return basis_.cols(); }

  // Returns the weighted residuals of 'positions' (a row for each time) from the path that fits
  // them best in the sense of least squares.
  Eigen::MatrixX3d Residuals(const Eigen::MatrixX3d& positions) const;

 private:
  Eigen::VectorXd weights_;
  Eigen::MatrixXd basis_;  // orthonormal columns that span the weighted paths
};

}  // namespace kestrel
