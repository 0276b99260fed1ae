// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/landing/pattern_locator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "kestrel/landing/neighbor_correlation.h"

namespace kestrel {
namespace {

// The unknowns: pose (translation, then rotation vector), spread of the black, logarithm of the
// focal length's factor, shift of the principal point, distortion: what the cube of the distance
// from the principal point adds to it, in focal lengths. A single view tells too little of the
// distortion to be solved for it; what it says is told all the same.
constexpr int kPoseUnknowns = 6;
constexpr int kSpread = 6;
constexpr int kFocal = 7;
constexpr int kDistortion = 10;
constexpr int kCalibrationUnknowns = 4;
constexpr int kUnknowns = 11;
using PoseVector = Eigen::Matrix<double, kPoseUnknowns, 1>;
using Vector = Eigen::Matrix<double, kUnknowns, 1>;
using Matrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;

constexpr std::size_t kMinEdges = 12;  // too few of those for a pose
constexpr int kMaxSteps = 8;
constexpr int kLeastSteps = 3;
constexpr double kFarScalePx = 1000;  // of the edges in the first step
constexpr double kLeastScalePx = 0.25;
constexpr double kSettledPx = 0.08;      // outlines that move by less stay where they are
constexpr double kMaxCorrelation = 0.9;  // of neighbouring residuals
constexpr double kBlurSpreadPx2 = 0.3;   // of the blur's square, over lenses: 0.45 to 0.9 px
// Bright white spreads over the black where the image is overexposed, and ink runs: least spread
// that is believed, and the same in its standard deviations. Less is as likely noise, or what
// narrow strokes do to each other's edges.
constexpr double kLeastSpreadPx = 0.12;
constexpr double kSureSpread = 2;
// A wrong calibration, standard deviations: of the logarithm of the focal length, and of the
// principal point in focal lengths. It is believed when right ones are as far from what the edges
// say, squared and in their covariance, in one of a million views.
constexpr double kFocalSigma = 0.25;
constexpr double kPrincipalSigma = 0.1;
constexpr double kSureCalibration = 30;
constexpr double kDoubtfulCalibration = 8;  // from where it is worth to find out
// Size of a ring, in focal lengths, over which the lens may bend otherwise than one number says.
constexpr double kWideRing = 0.6;
constexpr double kHeld = 1e6;  // weight, in edges, of what is not to move

// Of rings that are to be located yet.
constexpr std::size_t kCoarseStride = 3;  // places per place that is looked at first
constexpr double kWholeRing = 0.75;       // share of the places that have an edge
constexpr double kRingSettledPx = 0.2;
constexpr double kMaxRingScatterPx = 1.5;  // standard deviation, after two iterations
constexpr double kGathering = 0.6;         // of edges that gather still, from step to step

}  // namespace

// Where the outlines are in the image.
struct PatternLocator::State {
  RigidTransform pose;
  double spread_px = 0;  // of the black over the white: how far each edge is off its outline
  double log_focal = 0;
  Eigen::Vector2d principal_px = Eigen::Vector2d::Zero();

  // Where a lens with the state's calibration shows what the camera's shows at 'pixel'.
  Eigen::Vector2d Recalibrated(const Eigen::Vector2d& pixel,
                               const Eigen::Vector2d& principal) const {
    return principal + principal_px + std::exp(log_focal) * (pixel - principal);
  }

  // Changes the unknowns by a step; false when that is no small change.
  bool Move(const Vector& step) {
    const Eigen::Vector3d turn = step.segment<3>(3);
    if (!step.allFinite() || turn.norm() > 1) return false;
    pose = Moved(pose, step.head<3>(), turn);
    spread_px += step(kSpread);
    log_focal += step(kFocal);
    principal_px += step.segment<2>(kFocal + 1);
    return true;
  }
};

// Normal equations of a step.
struct PatternLocator::Equations {
  Matrix h = Matrix::Zero();
  Vector g = Vector::Zero();

  // Adds that an unknown should be 0, where it is 'value' now.
  void PullToZero(int unknown, double value, double weight) {
    h(unknown, unknown) += weight;
    g(unknown) -= weight * value;
  }
  void HoldSpread(const State& state) { PullToZero(kSpread, state.spread_px, kHeld); }
  void PullCalibration(const State& state, double focal_weight, double principal_weight) {
    PullToZero(kFocal, state.log_focal, focal_weight);
    PullToZero(kFocal + 1, state.principal_px.x(), principal_weight);
    PullToZero(kFocal + 2, state.principal_px.y(), principal_weight);
    PullToZero(kDistortion, 0, kHeld);
  }
};

// The edges as a state has them, and the equations that they make.
struct PatternLocator::Linearized {
  struct Edge {
    const PrintOutline::Place* place;
    Vector jacobian;  // of the offset
    double offset;    // px, from where the state has it
    double shift;     // px, of where the state has it from where the camera's own lens does
    double weight;
    bool follows;  // the edge before is its neighbour on the outline
  };

  // Standard deviation of the offsets by the median of their magnitudes.
  double RobustScale() {
    const auto middle = magnitudes.begin() + static_cast<std::ptrdiff_t>(found / 2);
    std::nth_element(magnitudes.begin(), middle,
                     magnitudes.begin() + static_cast<std::ptrdiff_t>(found));
    return 1.4826 * static_cast<double>(*middle);
  }

  // By how much (px, root mean square) 'step' moves the outlines in the image.
  double Movement(const Vector& step) const {
    return std::sqrt(std::max(0.0, step.dot(equations.h * step)) / weights);
  }

  Equations equations;
  Vector by_blur = Vector::Zero();  // derivative of their right side
  double weights = 0;
  std::array<Edge, PrintOutline::kMaxPlaces> edges;  // that have a weight
  std::size_t used = 0;
  std::array<float, PrintOutline::kMaxPlaces> magnitudes;  // of all offsets
  std::size_t found = 0;
};

// What the edges are off the state once it has moved by a step.
struct PatternLocator::Residuals {
  Residuals(const Linearized& linearized, const Vector& step)
      : used(static_cast<double>(linearized.used)), weights(linearized.weights) {
    double before = 0;
    for (const Linearized::Edge& edge : std::span(linearized.edges).first(linearized.used)) {
      const double residual = edge.offset - edge.jacobian.dot(step);
      weighted_squares += edge.weight * residual * residual;
      const double by_camera =
          residual + edge.shift + edge.jacobian.segment<3>(kFocal).dot(step.segment<3>(kFocal));
      camera_squares += edge.weight * by_camera * by_camera;
      Stretch& stretch = outline[2 * edge.place->part + edge.place->side];
      stretch.sum += edge.weight * residual;
      stretch.weights += edge.weight;
      if (edge.follows) neighbors.Add(before, residual);
      before = residual;
    }
  }

  double MeanSquare() const { return weighted_squares / weights; }
  // The same of what they are off where the camera's own lens has them.
  double CameraMeanSquare() const { return camera_squares / weights; }

  // Variance of an edge as the pose sees it: what neighbours have in common does not average out,
  // and what whole stretches of an outline have in common shows in how their means differ.
  double EdgeVariance() const {
    constexpr double kStretchEdges = 3;
    const double freedom = std::max(1.0, used - kPoseUnknowns) / used;
    const double of_edges = MeanSquare() / freedom * neighbors.Redundancy(kMaxCorrelation);
    double squares = 0;
    int stretches = 0;
    for (const Stretch& stretch : outline) {
      if (stretch.weights < kStretchEdges) continue;
      squares += stretch.sum * stretch.sum / stretch.weights;
      ++stretches;
    }
    const double of_stretches_freedom = stretches - kPoseUnknowns;
    if (of_stretches_freedom < 1) return of_edges;
    // By so much such means differ by chance in one of twenty prints (F distribution).
    constexpr double kByChance = 1.9;
    const double of_stretches = squares / of_stretches_freedom;
    return of_stretches > kByChance * of_edges ? of_stretches : of_edges;
  }

  struct Stretch {
    double sum = 0;  // of weighted residuals
    double weights = 0;
  };
  double used;
  double weights;
  double weighted_squares = 0;
  double camera_squares = 0;
  NeighborCorrelation neighbors;
  std::array<Stretch, 2 * PrintOutline::kParts> outline{};  // by part and side
};

PatternLocator::PatternLocator(const CameraModel& camera, const LandingPattern& pattern)
    : camera_(camera), outline_(pattern) {}

Eigen::Vector2d PatternLocator::Principal() const {
  return {camera_.intrinsics().cx_px, camera_.intrinsics().cy_px};
}

// What the edges say of the state, weighted by Tukey's function of their offsets with the given
// scale.
PatternLocator::Linearized PatternLocator::Linearize(const PrintEdges& edges, const State& state,
                                                     double scale_px) const {
  Linearized linearized;
  Equations& equations = linearized.equations;
  const Eigen::Matrix<double, 3, 2> plane = state.pose.rotation.toRotationMatrix().leftCols<2>();
  const Eigen::Vector2d principal = Principal();
  const double zoom = std::exp(state.log_focal);
  const double focal_px = zoom * camera_.intrinsics().fx_px;
  Eigen::Matrix<double, 2, 3> d_pixel;
  bool has_edge_before = false;
  for (const PrintEdge& found : edges.all()) {
    const bool follows = std::exchange(has_edge_before, false) && found.follows;
    const Eigen::Vector3d from_center = plane * found.place->point;
    Eigen::Vector2d pixel;
    if (camera_.Project(from_center + state.pose.translation, &pixel, &d_pixel) ==
        ProjectionStatus::kOutsideModel) {
      continue;
    }
    const Eigen::Vector2d by_camera = pixel;
    const Eigen::Vector2d from_principal = zoom * (pixel - principal);
    pixel = state.Recalibrated(pixel, principal);
    const double offset = found.across.dot(found.pixel() - pixel) - state.spread_px;
    linearized.magnitudes[linearized.found++] = static_cast<float>(std::abs(offset));
    const double ratio = offset / (4 * scale_px);
    if (std::abs(ratio) >= 1) continue;
    const double weight = (1 - ratio * ratio) * (1 - ratio * ratio);
    const Eigen::Vector3d d_point = zoom * d_pixel.transpose() * found.across;
    Linearized::Edge& edge = linearized.edges[linearized.used++];
    edge.place = found.place;
    const double radial = found.across.dot(from_principal);
    edge.jacobian << d_point, from_center.cross(d_point), 1, radial, found.across,
        radial * from_principal.squaredNorm() / (focal_px * focal_px);
    edge.offset = offset;
    edge.shift = found.across.dot(pixel - by_camera);
    edge.weight = weight;
    edge.follows = follows;
    const Vector weighted = weight * edge.jacobian;
    for (int c = 0; c < kUnknowns; ++c) equations.h.col(c) += edge.jacobian(c) * weighted;
    equations.g += offset * weighted;
    linearized.by_blur += found.bend * weighted;
    linearized.weights += weight;
    has_edge_before = true;
  }
  return linearized;
}

// What equations say of their unknowns. 'more_variance': of an edge, px^2, beside what the
// residuals show.
struct PatternLocator::Solution {
  Solution(const Linearized& linearized, const Equations& equations, double more_variance = 0)
      : decomposition(equations.h),
        step(decomposition.solve(equations.g)),
        residuals(linearized, step),
        variance(residuals.EdgeVariance() + more_variance) {}

  Matrix Covariance() const { return variance * decomposition.solve(Matrix::Identity().eval()); }
  double Sigma(int unknown) const {
    const double inverse = decomposition.solve(Vector::Unit(unknown))(unknown);
    return std::sqrt(variance * inverse);
  }

  Eigen::LDLT<Matrix> decomposition;
  Vector step;
  Residuals residuals;
  double variance;  // of an edge, px^2
};

// The step of a state whose calibration stays as it is. The spread is held at none unless the edges
// leave no doubt: to ask for it always would cost a sixth of the accuracy where there is none, and
// a part of a print bends to what is beside it.
PatternLocator::Solution PatternLocator::SolvePose(const Linearized& linearized, const State& state,
                                                   const std::optional<NormalPrior>& prior,
                                                   bool has_spread) {
  Equations equations = linearized.equations;
  if (prior) {
    const double variance = Residuals(linearized, Vector::Zero()).EdgeVariance();
    prior->AddTo(state.pose.rotation, variance, &equations.h, &equations.g);
  }
  equations.PullCalibration(state, kHeld, kHeld);
  if (has_spread) {
    Solution solution(linearized, equations);
    const double least = std::max(kLeastSpreadPx, kSureSpread * solution.Sigma(kSpread));
    if (std::abs(state.spread_px + solution.step(kSpread)) > least) return solution;
  }
  equations.HoldSpread(state);
  return {linearized, equations};
}

// The step of a state of which everything is asked. A print that is not quite flat seems to be seen
// through another lens.
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
    return {linearized, equations, unflat};
  };
  // What the step explains of the offsets is no variance of the edges.
  const double before = Residuals(linearized, Vector::Zero()).EdgeVariance() + unflat;
  return solve(solve(before).variance);
}

// What the edges alone say of the calibration, whatever the pose: nothing that was known before is
// in it, for all views have that in common.
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
  evidence->edge_variance = solution.residuals.EdgeVariance();
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

// What a solution leaves of the offsets makes the covariance of the pose.
void PatternLocator::Describe(const Linearized& linearized, const Solution& solution,
                              PatternLocation* location) {
  const Vector blur = kBlurSpreadPx2 * solution.decomposition.solve(linearized.by_blur);
  location->covariance = (solution.Covariance() + blur * blur.transpose()).topLeftCorner<6, 6>();
  location->edge_rms_px = std::sqrt(solution.residuals.MeanSquare());
  location->misfit_px = std::sqrt(solution.residuals.CameraMeanSquare());
}

// Where the calibration may be wrong the pose is as uncertain as without it, and by as much as it
// would move.
void PatternLocator::DoubtCalibration(const Solution& held, const Solution& free,
                                      PatternLocation* location) {
  const PoseVector moved = (free.step - held.step).head<kPoseUnknowns>();
  location->covariance += free.Covariance().topLeftCorner<6, 6>() + moved * moved.transpose();
}

std::optional<PatternLocation> PatternLocator::Locate(
    const PrintEdges& edges, const RigidTransform& initial,
    const std::optional<NormalPrior>& prior) const {
  const bool is_part = edges.IsPart();
  PatternLocation location;
  State state{initial};
  double scale = kFarScalePx;
  for (int i = 1; i <= kMaxSteps; ++i) {
    Linearized linearized = Linearize(edges, state, scale);
    if (linearized.used < kMinEdges) return std::nullopt;
    const bool near = i >= kLeastSteps;
    const Solution solution = SolvePose(linearized, state, prior, near && !is_part);
    // The tilt of a pattern that is seen from straight above moves the edges by its square only:
    // there the steps are short of the goal.
    const bool is_last =
        i == kMaxSteps || (near && linearized.Movement(solution.step) < kSettledPx);
    if (is_last) {
      Describe(linearized, solution, &location);
      const Solution free = SolveCalibration(linearized, state, prior);
      const CalibrationEvidence evidence = Judge(linearized, free, state);
      if (evidence.surprise > kDoubtfulCalibration) {
        DoubtCalibration(solution, free, &location);
      }
      // A part of a print bends to any calibration.
      if (!is_part) location.calibration = evidence;
    }
    if (!state.Move(solution.step)) return std::nullopt;
    scale = std::clamp(linearized.RobustScale(), kLeastScalePx, scale);
    if (i == 1) scale = std::max(scale, 1.0);
    if (is_last) break;
  }
  if (location.calibration.surprise > kDoubtfulCalibration) {
    Recalibrate(edges, prior, &state, &location);
  }
  if (!location.covariance.allFinite()) return std::nullopt;
  location.camera_from_pattern = state.pose;
  if (camera_.Project(state.pose.translation, &location.center_px) ==
      ProjectionStatus::kOutsideModel) {
    return std::nullopt;
  }
  location.center_px = state.Recalibrated(location.center_px, Principal());
  return location;
}

// Asks the edges for the calibration too; changes state and location where they contradict the
// camera's.
void PatternLocator::Recalibrate(const PrintEdges& edges, const std::optional<NormalPrior>& prior,
                                 State* state, PatternLocation* location) const {
  location->calibration = {};
  State free = *state;
  double scale = kFarScalePx;
  for (int i = 1; i <= kMaxSteps; ++i) {
    Linearized linearized = Linearize(edges, free, scale);
    if (linearized.used < kMinEdges) return;
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
    scale = std::clamp(linearized.RobustScale(), kLeastScalePx, scale);
    if (i == 1) scale = std::max(scale, 1.0);
  }
}

std::optional<RingLocation> PatternLocator::LocateRing(
    const cv::Mat& image, const RigidTransform& initial, double reach_px, double min_step,
    int iterations, const std::optional<NormalPrior>& prior) const {
  State state{initial};
  double scale = std::max(1.0, 0.5 * reach_px);
  double reach = reach_px;
  const std::span<const PrintOutline::Place> places = outline_.ring();
  const auto whole = static_cast<std::size_t>(kWholeRing * places.size() / kCoarseStride);
  bool is_whole = false;
  PrintEdges edges;
  const auto measure = [&](std::size_t stride) {
    const PlaneWarp warp(camera_, state.pose, outline_.radius_m());
    FindPrintEdges(image, {}, warp, places, {reach, min_step, stride}, &edges);
    return Linearize(edges, state, scale);
  };
  for (int i = 0; i < iterations; ++i) {
    Linearized linearized = measure(kCoarseStride);
    is_whole = linearized.used >= whole;
    if (!is_whole) {
      linearized = measure(1);
      is_whole = linearized.used >= kCoarseStride * whole;
    }
    if (linearized.used < kMinEdges) return std::nullopt;
    // A ring says nothing about turns in its plane, and a short arc little about its far side.
    Matrix& h = linearized.equations.h;
    h.diagonal() *= 1 + 1e-4;
    const double weight = 1e-6 * h.diagonal().segment<3>(3).maxCoeff();
    for (int k = 3; k < 6; ++k) h(k, k) += weight;
    const Vector step = SolvePose(linearized, state, prior, false).step;
    if (!state.Move(step)) return std::nullopt;
    const double before =
        std::exchange(scale, std::clamp(linearized.RobustScale(), kLeastScalePx, scale));
    reach = std::clamp(3 * scale, 1.5, reach);
    // The edges of anything but a ring stay scattered.
    const bool gathers = scale < kGathering * before && i + 1 < iterations;
    if (i > 0 && scale > kMaxRingScatterPx && !gathers) return std::nullopt;
    if (i > 0 && linearized.Movement(step) < kRingSettledPx) break;
  }
  return RingLocation{state.pose, is_whole};
}

}  // namespace kestrel
