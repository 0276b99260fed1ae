// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/landing/gray_doubts.h"

#include <algorithm>
#include <cmath>

namespace kestrel {
namespace {

constexpr double kLeastLacking = 1e-3;  // of a correlation of 1
constexpr double kLeastSigma = 1e-4;

double LogLacking(double correlation) { return std::log(std::max(kLeastLacking, 1 - correlation)); }

}  // namespace

void DoubtParts(const PatternMatch& match, PrintDoubts* doubts) {
  const PartShares::Means means = match.shares.MeansInView();
  (*doubts)[PrintDoubt::kArmMissing] = 1 - means.worst_arm;
  (*doubts)[PrintDoubt::kArmsWeak] = 1 - means.arms;
  (*doubts)[PrintDoubt::kDarkQuadrant] = 1 - means.quadrants;
  (*doubts)[PrintDoubt::kBrokenRing] = 1 - means.ring;
  (*doubts)[PrintDoubt::kHidden] = 1 - match.seen;
}

void DoubtGrayValues(const SmallPatternFitter::Fit& fit, PrintDoubts* doubts) {
  (*doubts)[PrintDoubt::kOtherSpokes] = fit.others.spokes;
  (*doubts)[PrintDoubt::kFrameCorners] = fit.others.frame_corners;
  (*doubts)[PrintDoubt::kDarkBoard] = fit.others.board_darkness;
  (*doubts)[PrintDoubt::kOtherFigure] = LogLacking(fit.others.cross_correlation);
  (*doubts)[PrintDoubt::kUnlike] = LogLacking(fit.correlation);
  (*doubts)[PrintDoubt::kUnexplained] = 1 - fit.explained;
  (*doubts)[PrintDoubt::kInside] = fit.inside_residual - fit.ring_residual;
  (*doubts)[PrintDoubt::kOnRing] = fit.ring_residual - fit.inside_residual;
  (*doubts)[PrintDoubt::kAround] =
      fit.white_residual - std::max(fit.inside_residual, fit.ring_residual);
}

void DoubtView(const Eigen::Vector2d& diameters_px, double relative_sigma, PrintDoubts* doubts) {
  (*doubts)[PrintDoubt::kUncertain] = std::log(std::max(kLeastSigma, relative_sigma));
  (*doubts)[PrintDoubt::kSmall] = -0.5 * std::log(std::max(1.0, diameters_px.prod()));
  (*doubts)[PrintDoubt::kFlat] =
      -std::log(std::max(0.01, diameters_px.y() / std::max(1.0, diameters_px.x())));
}

}  // namespace kestrel
