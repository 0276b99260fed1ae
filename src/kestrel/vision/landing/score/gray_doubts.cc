// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/score/gray_doubts.h"

#include <algorithm>
#include <cmath>

namespace kestrel {
namespace {

constexpr double kLeastShare = 1e-4;  // less than any that a weight tells apart

}  // namespace

double LogShare(double share) { return std::log(std::max(kLeastShare, share)); }

void DoubtGrayValues(const SmallPatternFitter::Fit& fit, PrintDoubts* doubts) {
  const PartShares::Means means = fit.shares.MeansInView();
  (*doubts)[PrintDoubt::kFaintArm] = 1 - means.worst_arm;
  (*doubts)[PrintDoubt::kBrokenRing] = 1 - means.ring;
  (*doubts)[PrintDoubt::kFrameCorners] = fit.frame_corners;
  (*doubts)[PrintDoubt::kOtherFigure] = LogShare(1 - fit.cross_correlation);
  (*doubts)[PrintDoubt::kInside] = fit.inside_residual - fit.ring_residual;
}

void DoubtView(const Eigen::Vector2d& diameters_px, double relative_sigma, PrintDoubts* doubts) {
  (*doubts)[PrintDoubt::kUncertain] = LogShare(relative_sigma);
  (*doubts)[PrintDoubt::kSmall] = -std::log(std::max(1.0, diameters_px.y()));
  (*doubts)[PrintDoubt::kFlat] = -LogShare(diameters_px.y() / std::max(1.0, diameters_px.x()));
}

}  // namespace kestrel
