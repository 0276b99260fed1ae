// SPDX-License-Identifier: BSD-3-Clause
// Evidence of the edges about the camera's calibration.
#include <cmath>

#include <Eigen/Cholesky>

#include "kestrel/vision/landing/location/pattern_locator_equations.h"

namespace kestrel {
namespace {

// Prior standard deviations of the calibration: logarithm of the focal length, and principal point
// in focal lengths. Another calibration is accepted above a squared Mahalanobis distance that right
// calibrations exceed in one of a million views.
constexpr double kFocalSigma = 0.25;
constexpr double kPrincipalSigma = 0.1;
constexpr double kSureCalibration = 30;
// Width of a ring, in focal lengths, over which one number no longer describes the lens's
// distortion.
constexpr double kWideRing = 0.6;

}  // namespace

// Returns the step for all unknowns. The edges have additional variance, because a print that is
// not quite flat looks like one seen through another lens.
PatternLocator::Solution PatternLocator::SolveCalibration(
    const Linearized& linearized, const State& state,
    const std::optional<NormalPrior>& prior) const {
  const double focal_px = camera_.intrinsics().fx_px;
  const double principal_sigma_px = kPrincipalSigma * focal_px;
  const double diameter_px = 2 * outline_.radius_m() * focal_px / state.pose.translation.norm();
  const double unflat = std::pow(kUnflatShare * diameter_px, 2);
  const auto solve = [&](double variance) -> Solution {
    Equations equations = linearized.equations;
    if (prior) prior->AddTo(state.pose.rotation, variance, &equations.h, &equations.g);
    equations.PullCalibration(state, variance / (kFocalSigma * kFocalSigma),
                              variance / (principal_sigma_px * principal_sigma_px));
    return Solution::Of<kUnknowns>(linearized, equations, unflat);
  };
  // The part of the offsets that the step explains does not count as variance of the edges.
  const double before = Residuals(linearized, Vector::Zero(), 0).EdgeVariance() + unflat;
  return solve(solve(before).edge_variance);
}

// Sets the evidence of the edges alone about the calibration, whatever the pose. It contains no
// prior, because all views share the same prior.
void PatternLocator::AddInformation(const Linearized& linearized, const Solution& solution,
                                    const State& state, CalibrationEvidence* evidence) const {
  using OfPose = Eigen::Matrix<double, kFocal, kFocal>;
  using Calibration = Eigen::Matrix<double, kCalibrationUnknowns, 1>;
  if (2 * outline_.radius_m() > kWideRing * state.pose.translation.norm()) return;
  const Matrix& h = linearized.equations.h;
  const Vector& g = linearized.equations.g;
  const Eigen::LDLT<OfPose> of_pose(h.topLeftCorner<kFocal, kFocal>());
  const auto mixed = h.topRightCorner<kFocal, kCalibrationUnknowns>().eval();
  const auto by_pose = of_pose.solve(mixed).eval();
  const Eigen::Matrix4d information =
      h.bottomRightCorner<kCalibrationUnknowns, kCalibrationUnknowns>() -
      mixed.transpose() * by_pose;
  const Calibration at(state.log_focal, state.principal_px.x(), state.principal_px.y(), 0);
  const Calibration pull =
      information * at + g.tail<kCalibrationUnknowns>() - by_pose.transpose() * g.head<kFocal>();
  const double focal_px = camera_.intrinsics().fx_px;
  const Calibration unit(1, focal_px, focal_px, 1);
  evidence->edge_variance = solution.scatter_variance;
  evidence->information = unit.asDiagonal() * information * unit.asDiagonal();
  evidence->information /= evidence->edge_variance;
  evidence->pull = unit.cwiseProduct(pull) / evidence->edge_variance;
}

CalibrationEvidence PatternLocator::Judge(const Linearized& linearized, const Solution& solution,
                                          const State& state) const {
  const Matrix covariance = solution.Covariance();
  Eigen::Vector3d error(state.log_focal, state.principal_px.x(), state.principal_px.y());
  error += solution.step.segment<3>(kFocal);
  CalibrationEvidence evidence;
  evidence.log_focal = error.x();
  evidence.log_focal_sigma = std::sqrt(covariance(kFocal, kFocal));
  evidence.principal_px = error.tail<2>();
  const Eigen::Matrix3d of_error = covariance.block<3, 3>(kFocal, kFocal);
  evidence.surprise = error.dot(of_error.ldlt().solve(error));
  AddInformation(linearized, solution, state, &evidence);
  return evidence;
}

// Adds, when the calibration may be wrong, to the covariance the uncertainty of the pose under a
// free calibration and the distance by which that pose would move.
void PatternLocator::DoubtCalibration(const Solution& held, const Solution& free,
                                      PatternLocation* location) {
  const PoseVector moved = (free.step - held.step).head<kPoseUnknowns>();
  location->covariance +=
      free.Covariance().topLeftCorner<kPoseUnknowns, kPoseUnknowns>() + moved * moved.transpose();
}

// Solves for the calibration too. Changes state and location where the edges contradict the
// camera's calibration.
void PatternLocator::Recalibrate(const EdgeColumns& edges, const std::optional<NormalPrior>& prior,
                                 State* state, PatternLocation* location) const {
  location->calibration = {};
  State free = *state;
  Linearized linearized(edges);
  double scale = Linearized::kFarScalePx;
  for (int i = 1; i <= kMaxSteps; ++i) {
    Linearize(free, scale, kUnknowns, &linearized);
    if (linearized.used < EdgeFit::kLeastEdges) return;
    const Solution solution = SolveCalibration(linearized, free, prior);
    if (i == kMaxSteps || linearized.Movement(solution.step) < kSettledPx) {
      location->calibration = Judge(linearized, solution, free);
      location->calibration.contradicts = location->calibration.surprise > kSureCalibration;
      if (!location->calibration.contradicts || !free.Move(solution.step)) return;
      Describe(linearized, solution, location);
      *state = free;
      return;
    }
    if (!free.Move(solution.step)) return;
    scale = linearized.NextScale(scale);
  }
}

}  // namespace kestrel
