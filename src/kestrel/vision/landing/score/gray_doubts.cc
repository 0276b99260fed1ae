// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/score/gray_doubts.h"

#include <algorithm>
#include <cmath>

namespace kestrel {
namespace {

constexpr double kLeastLacking = 1e-3;  // least value of (1 - correlation)
constexpr double kLeastSigma = 1e-4;

}  // namespace

double LogLacking(double correlation) { return std::log(std::max(kLeastLacking, 1 - correlation)); }

void DoubtGrayValues(const SmallPatternFitter::Fit& fit, PrintDoubts* doubts) {
  const PartShares::Means means = fit.shares.MeansInView();
  (*doubts)[PrintDoubt::kFaintArm] = 1 - means.worst_arm;
  (*doubts)[PrintDoubt::kBrokenRing] = 1 - means.ring;
  (*doubts)[PrintDoubt::kFrameCorners] = fit.frame_corners;
  (*doubts)[PrintDoubt::kOtherFigure] = LogLacking(fit.cross_correlation);
  (*doubts)[PrintDoubt::kInside] = fit.inside_residual - fit.ring_residual;
}

void DoubtView(const Eigen::Vector2d& diameters_px, double relative_sigma, PrintDoubts* doubts) {
  (*doubts)[PrintDoubt::kUncertain] = std::log(std::max(kLeastSigma, relative_sigma));
  (*doubts)[PrintDoubt::kSmall] = -std::log(std::max(1.0, diameters_px.y()));
  (*doubts)[PrintDoubt::kFlat] =
      -std::log(std::max(0.01, diameters_px.y() / std::max(1.0, diameters_px.x())));
}

}  // namespace kestrel
