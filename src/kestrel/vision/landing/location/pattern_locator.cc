// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/location/pattern_locator.h"

#include <algorithm>
#include <cmath>

#include "kestrel/vision/landing/image_properties.h"
#include "kestrel/vision/landing/location/pattern_locator_equations.h"

namespace kestrel {
namespace {

constexpr int kLeastSteps = 3;
// Bright white spreads over the black in overexposed images, and ink runs. Least spread that is
// accepted, in pixels and in its standard deviations. A smaller one may be noise, or the effect of
// a narrow stroke's edges on each other.
constexpr double kLeastSpreadPx = 0.12;
constexpr double kSureSpread = 2;

}  // namespace

PatternLocator::PatternLocator(const CameraModel& camera, const LandingPattern& pattern)
    : camera_(camera), outline_(pattern) {}

Eigen::Vector2d PatternLocator::Principal() const {
  return {camera_.intrinsics().cx_px, camera_.intrinsics().cy_px};
}

// Adds the prior of the plane, weighted by the variance of the edges.
PatternLocator::Equations PatternLocator::WithPrior(const Linearized& linearized,
                                                    const State& state,
                                                    const std::optional<NormalPrior>& prior) {
  Equations equations = linearized.equations;
  if (prior) {
    const double variance = Residuals(linearized, Vector::Zero(), 0).EdgeVariance();
    prior->AddTo(state.pose.rotation, variance, &equations.h, &equations.g);
  }
  return equations;
}

// Returns the step of a state with a fixed calibration. The spread is held at 0 unless the edges
// leave no doubt: to estimate it always would cost a sixth of the accuracy where there is none. For
// a partial print the spread is not estimated, because it would fit whatever lies beside the print.
PatternLocator::Solution PatternLocator::SolvePose(const Linearized& linearized, const State& state,
                                                   const std::optional<NormalPrior>& prior,
                                                   bool has_spread) {
  Equations equations = WithPrior(linearized, state, prior);
  if (has_spread) {
    Solution solution = Solution::Of<kPoseUnknowns + 1>(linearized, equations);
    const double least = std::max(kLeastSpreadPx, kSureSpread * solution.Sigma(kSpread));
    if (std::abs(state.spread_px + solution.step(kSpread)) > least) return solution;
  }
  if (state.spread_px == 0) return Solution::Of<kPoseUnknowns>(linearized, equations);
  equations.PullToZero(kSpread, state.spread_px, Equations::kHeld);
  return Solution::Of<kPoseUnknowns + 1>(linearized, equations);
}

// Sets covariance and residuals of the location from a solution.
void PatternLocator::Describe(const Linearized& linearized, const Solution& solution,
                              PatternLocation* location) {
  const Vector blur = LensBlur::kSquareSpreadPx2 * solution.inverse * linearized.by_blur;
  location->covariance = (solution.Covariance() + blur * blur.transpose())
                             .topLeftCorner<kPoseUnknowns, kPoseUnknowns>();
  location->edge_rms_px = std::sqrt(solution.mean_square);
  location->misfit_px = std::sqrt(solution.camera_mean_square);
}

std::optional<PatternLocation> PatternLocator::Locate(
    const PrintEdges& found, const RigidTransform& initial,
    const std::optional<NormalPrior>& prior) const {
  const bool is_part = found.IsPart();
  PatternLocation location;
  State state{initial};
  double scale = Linearized::kFarScalePx;
  if (found.count >= EdgeFit::kCoarseStride * EdgeFit::kFewEdges) {
    if (!Approach(EdgeColumns(found, EdgeFit::kCoarseStride), prior, &state, &scale))
      return std::nullopt;
  }
  const EdgeColumns edges(found, 1);
  Linearized linearized(edges);
  const int least_steps = scale < Linearized::kFarScalePx ? 1 : kLeastSteps;
  for (int i = 1; i <= kMaxSteps; ++i) {
    Linearize(state, scale, kUnknowns, &linearized);
    if (linearized.used < EdgeFit::kLeastEdges) return std::nullopt;
    const bool near = i >= least_steps;
    const Solution solution = SolvePose(linearized, state, prior, near && !is_part);
    // The tilt of a pattern seen from straight above moves the edges only by its square, so the
    // steps fall short and more of them are needed.
    const bool is_last =
        i == kMaxSteps || (near && linearized.Movement(solution.step) < kSettledPx);
    if (is_last) {
      Describe(linearized, solution, &location);
      const Solution free = SolveCalibration(linearized, state, prior);
      const CalibrationEvidence evidence = Judge(linearized, free, state);
      // A print that is not flat misleads the pose like a wrong lens.
      if (evidence.surprise * free.edge_variance > kDoubtfulCalibration * free.scatter_variance) {
        DoubtCalibration(solution, free, &location);
      }
      // A partial print can be fitted under any calibration.
      if (!is_part) location.calibration = evidence;
    }
    if (!state.Move(solution.step)) return std::nullopt;
    scale = linearized.NextScale(scale);
    if (is_last) break;
  }
  if (location.calibration.surprise > kDoubtfulCalibration) {
    Recalibrate(edges, prior, &state, &location);
  }
  if (!location.covariance.allFinite()) return std::nullopt;
  location.camera_from_target = state.pose;
  if (camera_.Project(state.pose.translation, &location.center_px) ==
      ProjectionStatus::kOutsideModel) {
    return std::nullopt;
  }
  location.center_px = state.Recalibrated(location.center_px, Principal());
  return location;
}

// Moves the state near to the edges in 'edges', a part of all; false when they do not determine it.
bool PatternLocator::Approach(const EdgeColumns& edges, const std::optional<NormalPrior>& prior,
                              State* state, double* scale_px) const {
  Linearized linearized(edges);
  for (int i = 1; i <= kMaxSteps; ++i) {
    Linearize(*state, *scale_px, kPoseUnknowns, &linearized);
    if (linearized.used < EdgeFit::kLeastEdges) return false;
    const Vector step = WithPrior(linearized, *state, prior).PoseStep();
    if (!state->Move(step)) return false;
    *scale_px = linearized.NextScale(*scale_px);
    if (i >= kLeastSteps && linearized.Movement(step) < kSettledPx) break;
  }
  return true;
}

}  // namespace kestrel
