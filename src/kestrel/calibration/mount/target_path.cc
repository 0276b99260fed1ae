// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/mount/target_path.h"

#include <algorithm>
#include <cmath>

#include <Eigen/QR>

namespace kestrel {
namespace {

// The four cubic B-splines that are not zero at the fraction 's' (0 to 1) of a span.
Eigen::RowVector4d CubicBasis(double s) {
  const double r = 1 - s;
  return Eigen::RowVector4d(r * r * r, 3 * s * s * s - 6 * s * s + 4, 3 * r * r * r - 6 * r * r + 4,
                            s * s * s) /
         6;
}

Eigen::MatrixXd SplineDesign(const std::vector<Time>& times, double knot_spacing_s) {
  const double duration_s = ToSeconds(times.back() - times.front());
  const auto spans =
      std::max<Eigen::Index>(1, static_cast<Eigen::Index>(std::ceil(duration_s / knot_spacing_s)));
  Eigen::MatrixXd design =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(times.size()), spans + 3);
  for (Eigen::Index i = 0; i < design.rows(); ++i) {
    const double at = ToSeconds(times[i] - times.front()) / knot_spacing_s;
    const Eigen::Index span = std::min(static_cast<Eigen::Index>(at), spans - 1);
    design.block<1, 4>(i, span) = CubicBasis(at - static_cast<double>(span));
  }
  return design;
}

}  // namespace

TargetPath::TargetPath(const std::vector<Time>& times, const Eigen::VectorXd& weights,
                       double knot_spacing_s)
    : weights_(weights) {
  Eigen::MatrixXd design = knot_spacing_s > 0 ? SplineDesign(times, knot_spacing_s)
                                              : Eigen::MatrixXd::Ones(weights.size(), 1);
  // Columns without data (a gap in the flight) do not add to the rank and are dropped.
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(weights_.asDiagonal() * design);
  basis_ = qr.householderQ() * Eigen::MatrixXd::Identity(weights.size(), qr.rank());
}

Eigen::MatrixX3d TargetPath::Residuals(const Eigen::MatrixX3d& positions) const {
  const Eigen::MatrixX3d weighted = weights_.asDiagonal() * positions;
  return weighted - basis_ * (basis_.transpose() * weighted);
}

}  // namespace kestrel
