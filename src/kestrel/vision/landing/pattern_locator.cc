// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/pattern_locator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "kestrel/core/base/robust_statistics.h"
#include "kestrel/vision/landing/column_products.h"
#include "kestrel/vision/landing/neighbor_correlation.h"

namespace kestrel {
namespace {

// The unknowns: pose (translation, then rotation vector), spread of the black, logarithm of the
// focal length's factor, shift of the principal point, and distortion (added to the distance from
// the principal point: distortion times its cube, in focal lengths). A single view determines the
// distortion too poorly to solve for it, but its information is reported.
constexpr int kPoseUnknowns = 6;
constexpr int kSpread = 6;
constexpr int kFocal = 7;
constexpr int kDistortion = 10;
constexpr int kCalibrationUnknowns = 4;
constexpr int kUnknowns = 11;
// Further columns: the offsets, and their derivatives by the square of the blur.
constexpr int kOffset = 11;
constexpr int kBlur = 12;
constexpr int kEdgeColumns = 13;
using Column = std::array<float, PrintOutline::kMaxPlaces>;
using PoseVector = Eigen::Matrix<double, kPoseUnknowns, 1>;
using Vector = Eigen::Matrix<double, kUnknowns, 1>;
using Matrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;

constexpr std::size_t kMinEdges = 12;  // least number of edges for a pose
constexpr int kMaxSteps = 8;
constexpr int kLeastSteps = 3;
constexpr double kHeld = 1e6;  // weight, in edges, that holds an unknown in place
// All steps but the last few use every kCoarseEdges-th edge, if there are kFewEdges of those.
constexpr std::size_t kCoarseEdges = 3;
constexpr std::size_t kFewEdges = 36;
constexpr double kFarScalePx = 1000;  // scale of the offsets in the first step
constexpr double kLeastScalePx = 0.25;
constexpr double kSettledPx = 0.08;      // outlines that move by less have settled
constexpr double kMaxCorrelation = 0.9;  // largest correlation of neighbouring residuals
constexpr double kBlurSpreadPx2 = 0.3;   // spread over lenses (0.45 to 0.9 px), squared
// Bright white spreads over the black in overexposed images, and ink runs. Least spread that is
// accepted, in pixels and in its standard deviations. A smaller one may be noise, or the effect of
// a narrow stroke's edges on each other.
constexpr double kLeastSpreadPx = 0.12;
constexpr double kSureSpread = 2;
// Prior standard deviations of the calibration: logarithm of the focal length, and principal point
// in focal lengths. Another calibration is accepted above a squared Mahalanobis distance that right
// calibrations exceed in one of a million views.
constexpr double kFocalSigma = 0.25;
constexpr double kPrincipalSigma = 0.1;
constexpr double kSureCalibration = 30;
constexpr double kDoubtfulCalibration = 8;  // above this the calibration is solved for
// Width of a ring, in focal lengths, over which one number no longer describes the lens's
// distortion.
constexpr double kWideRing = 0.6;

// For LocateRing.
constexpr std::size_t kCoarseStride = 3;  // the first measurement uses every kCoarseStride-th place
constexpr double kWholeRing = 0.75;  // least share of the places with an edge, for a whole ring
constexpr double kRingSettledPx = 0.2;
constexpr double kMaxRingScatterPx = 1.5;  // standard deviation, after two iterations
constexpr double kGathering = 0.6;  // edges still gather when a step scales their scatter by less

}  // namespace

// Predicts where the outlines are in the image.
struct PatternLocator::State {
  RigidTransform pose;
  double spread_px = 0;  // of the black over the white, at every edge
  double log_focal = 0;
  Eigen::Vector2d principal_px = Eigen::Vector2d::Zero();

  // Converts a pixel of the camera's own lens to the pixel under the state's calibration.
  Eigen::Vector2d Recalibrated(const Eigen::Vector2d& pixel,
                               const Eigen::Vector2d& principal) const {
    return principal + principal_px + std::exp(log_focal) * (pixel - principal);
  }

  // Changes the unknowns by a step; false when the step is too large.
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

  // Adds a prior that an unknown, now 'value', is 0.
  void PullToZero(int unknown, double value, double weight) {
    h(unknown, unknown) += weight;
    g(unknown) -= weight * value;
  }
  // Returns the step of the pose alone.
  Vector PoseStep() const {
    Vector step = Vector::Zero();
    step.head<kPoseUnknowns>() =
        h.topLeftCorner<kPoseUnknowns, kPoseUnknowns>().ldlt().solve(g.head<kPoseUnknowns>());
    return step;
  }
  void PullCalibration(const State& state, double focal_weight, double principal_weight) {
    PullToZero(kFocal, state.log_focal, focal_weight);
    PullToZero(kFocal + 1, state.principal_px.x(), principal_weight);
    PullToZero(kFocal + 2, state.principal_px.y(), principal_weight);
    PullToZero(kDistortion, 0, kHeld);
  }
};

// Every stride-th edge, by columns.
struct PatternLocator::EdgeColumns {
  EdgeColumns() = default;
  EdgeColumns(const PrintEdges& found, std::size_t stride) {
    for (std::size_t i = 0; i < found.count; i += stride, ++count) {
      const PrintEdge& edge = found.edges[i];
      const Eigen::Vector2d pixel = edge.pixel();
      x_m[count] = static_cast<float>(edge.place->point.x());
      y_m[count] = static_cast<float>(edge.place->point.y());
      across_x[count] = static_cast<float>(edge.across.x());
      across_y[count] = static_cast<float>(edge.across.y());
      x_px[count] = static_cast<float>(pixel.x());
      y_px[count] = static_cast<float>(pixel.y());
      bend[count] = static_cast<float>(edge.bend);
      stretch[count] = 2 * edge.place->part + edge.place->side;
      follows[count] = stride == 1 && edge.follows;
    }
  }

  std::size_t count = 0;
  Column x_m, y_m;            // place on the print
  Column across_x, across_y;  // normal of the outline in the image
  Column x_px, y_px;
  Column bend;
  std::array<int, PrintOutline::kMaxPlaces> stretch;  // index of the part and side
  std::array<bool, PrintOutline::kMaxPlaces> follows;
};

// The edges relative to a state, and the normal equations of a step.
struct PatternLocator::Linearized {
  explicit Linearized(const EdgeColumns& of) : edges(of) {}

  // Sums the columns to the normal equations of the first 'unknowns'.
  void Sum(int unknowns) {
    std::array<int, kEdgeColumns> which;
    std::array<const float*, kEdgeColumns> pointers;
    int count = 0;
    for (int k = 0; k < kEdgeColumns; ++k) {
      const bool is_asked = k < unknowns || k == kSpread || k == kOffset;
      if (!is_asked && unknowns < kUnknowns) continue;
      which[count] = k;
      pointers[count++] = columns[k].data();
    }
    std::array<double, kEdgeColumns * kEdgeColumns> sums;
    SumProducts(std::span(pointers).first(count), edges.count, sums.data());
    Eigen::Matrix<double, kEdgeColumns, kEdgeColumns> products;
    products.setZero();
    for (int a = 0; a < count; ++a) {
      for (int b = 0; b < count; ++b) products(which[a], which[b]) = sums[a * count + b];
    }
    equations.h = products.topLeftCorner<kUnknowns, kUnknowns>();
    equations.g = products.col(kOffset).head<kUnknowns>();
    by_blur = products.col(kBlur).head<kUnknowns>();
    weights = products(kSpread, kSpread);
  }

  // Standard deviation of the offsets from the median of their magnitudes.
  double RobustScale() const {
    Column magnitudes;
    std::size_t found = 0;
    for (std::size_t i = 0; i < edges.count; ++i) {
      magnitudes[found] = std::abs(offsets[i]);
      found += magnitudes[found] < kOutsideModelPx ? 1 : 0;
    }
    return RobustSigmaInPlace(std::span(magnitudes).first(found));
  }

  // Returns the scale of the offsets for the next step, given 'scale_px' of this one.
  double NextScale(double scale_px) const {
    const double scale = std::clamp(RobustScale(), kLeastScalePx, scale_px);
    return scale_px == kFarScalePx ? std::max(scale, 1.0) : scale;
  }

  // Returns the motion of the outlines in the image by 'step' (px, root mean square).
  double Movement(const Vector& step) const {
    return std::sqrt(std::max(0.0, step.dot(equations.h * step)) / weights);
  }

  static constexpr float kOutsideModelPx = 1e6f;  // offset of points that the lens does not show

  const EdgeColumns& edges;
  Column offsets;  // px, offset of each edge from its prediction by the state
  Column shifts;   // px, offset of that prediction from the one by the camera's own lens
  std::array<Column, kEdgeColumns>
      columns;           // times the root of the weight, which is that of the spread
  std::size_t used = 0;  // number of edges with a positive weight
  Equations equations;
  Vector by_blur;  // derivative of the right side by the square of the blur
  double weights;
};

// Residuals of the edges after the state has moved by a step.
struct PatternLocator::Residuals {
  Residuals(const Linearized& linearized, const Vector& step, int unknowns)
      : used(static_cast<double>(linearized.used)), weights(linearized.weights) {
    const EdgeColumns& edges = linearized.edges;
    Column residuals = linearized.columns[kOffset];  // times the root of the weight
    for (int k = 0; k < unknowns; ++k) {
      const Column& column = linearized.columns[k];
      const auto along = static_cast<float>(step(k));
      for (std::size_t i = 0; i < edges.count; ++i) residuals[i] -= along * column[i];
    }
    double before = 0;
    bool has_edge_before = false;
    for (std::size_t i = 0; i < edges.count; ++i) {
      const double root = linearized.columns[kSpread][i];
      const bool has_weight = root > 0;
      const bool follows = std::exchange(has_edge_before, has_weight) && edges.follows[i];
      if (!has_weight) continue;
      const double weighted = residuals[i];
      weighted_squares += weighted * weighted;
      double by_camera = weighted + root * linearized.shifts[i];
      for (int k = kFocal; k < std::min(kDistortion, unknowns); ++k) {
        by_camera += step(k) * linearized.columns[k][i];
      }
      camera_squares += by_camera * by_camera;
      Stretch& stretch = outline[edges.stretch[i]];
      stretch.sum += root * weighted;
      stretch.weights += root * root;
      const double residual = weighted / root;
      if (follows) neighbors.Add(before, residual);
      before = residual;
    }
  }

  double MeanSquare() const { return weighted_squares / weights; }
  // The same for residuals against the camera's own lens.
  double CameraMeanSquare() const { return camera_squares / weights; }

  // Variance of an edge as the pose sees it. Errors that neighbours share do not average out, and
  // errors that whole stretches of an outline share show in the differences of their means.
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
    // Ratio that such means exceed by chance in one of twenty prints (F distribution).
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

// Linearizes the edges about a state, with Tukey's weights at the scale 'scale_px', for its first
// 'unknowns'.
void PatternLocator::Linearize(const State& state, double scale_px, int unknowns,
                               Linearized* linearized) const {
  const EdgeColumns& edges = linearized->edges;
  const std::size_t count = edges.count;
  const Eigen::Matrix<float, 3, 2> plane =
      state.pose.rotation.toRotationMatrix().leftCols<2>().cast<float>();
  const Eigen::Vector3f center = state.pose.translation.cast<float>();
  std::array<Column, 3> from_center, points;
  for (int k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < count; ++i) {
      from_center[k][i] = plane(k, 0) * edges.x_m[i] + plane(k, 1) * edges.y_m[i];
      points[k][i] = center(k) + from_center[k][i];
    }
  }
  Column x_px, y_px;
  std::array<Column, 6> by_point;
  const std::array<float*, 6> derivatives{by_point[0].data(), by_point[1].data(),
                                          by_point[2].data(), by_point[3].data(),
                                          by_point[4].data(), by_point[5].data()};
  camera_.ProjectMany({points[0].data(), points[1].data(), points[2].data()}, count, x_px.data(),
                      y_px.data(), &derivatives);
  const Eigen::Vector2f principal = Principal().cast<float>();
  const Eigen::Vector2f shown = (Principal() + state.principal_px).cast<float>();
  const auto zoom = static_cast<float>(std::exp(state.log_focal));
  const auto per_focal_squared =
      static_cast<float>(1 / std::pow(zoom * camera_.intrinsics().fx_px, 2));
  const auto spread = static_cast<float>(state.spread_px);
  const auto per_limit = static_cast<float>(1 / (4 * scale_px));
  auto& columns = linearized->columns;
  Column& roots = columns[kSpread];
  for (std::size_t i = 0; i < count; ++i) {
    const float x = zoom * (x_px[i] - principal.x()), y = zoom * (y_px[i] - principal.y());
    const float offset = edges.across_x[i] * (edges.x_px[i] - shown.x() - x) +
                         edges.across_y[i] * (edges.y_px[i] - shown.y() - y) - spread;
    const float ratio = per_limit * offset;
    const float root = 1 - ratio * ratio;
    const float radial = edges.across_x[i] * x + edges.across_y[i] * y;
    columns[kFocal][i] = radial;
    columns[kDistortion][i] = radial * (x * x + y * y) * per_focal_squared;
    linearized->offsets[i] = offset;
    linearized->shifts[i] = edges.across_x[i] * (shown.x() + x - x_px[i]) +
                            edges.across_y[i] * (shown.y() + y - y_px[i]);
    roots[i] = root > 0 ? root : 0;
  }
  linearized->used = 0;
  for (std::size_t i = 0; i < count; ++i) {
    linearized->used += roots[i] > 0 ? 1 : 0;
    if (!std::isnan(linearized->offsets[i])) continue;
    linearized->offsets[i] = Linearized::kOutsideModelPx;
    linearized->shifts[i] = columns[kFocal][i] = columns[kDistortion][i] = 0;
    for (Column& column : by_point) column[i] = 0;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const float across_x = roots[i] * edges.across_x[i], across_y = roots[i] * edges.across_y[i];
    const float dx = zoom * (across_x * by_point[0][i] + across_y * by_point[3][i]);
    const float dy = zoom * (across_x * by_point[1][i] + across_y * by_point[4][i]);
    const float dz = zoom * (across_x * by_point[2][i] + across_y * by_point[5][i]);
    columns[0][i] = dx;
    columns[1][i] = dy;
    columns[2][i] = dz;
    columns[3][i] = from_center[1][i] * dz - from_center[2][i] * dy;
    columns[4][i] = from_center[2][i] * dx - from_center[0][i] * dz;
    columns[5][i] = from_center[0][i] * dy - from_center[1][i] * dx;
    columns[kFocal][i] *= roots[i];
    columns[kDistortion][i] *= roots[i];
    columns[kFocal + 1][i] = across_x;
    columns[kFocal + 2][i] = across_y;
    columns[kOffset][i] = roots[i] * linearized->offsets[i];
    columns[kBlur][i] = roots[i] * edges.bend[i];
  }
  linearized->Sum(unknowns);
}

// Solution of the equations for their first kCount unknowns; the others stay as they are.
// 'more_variance': variance of an edge, px^2, beyond what the residuals show.
struct PatternLocator::Solution {
  template <int kCount>
  static Solution Of(const Linearized& linearized, const Equations& equations,
                     double more_variance = 0) {
    using Part = Eigen::Matrix<double, kCount, kCount>;
    const Eigen::LDLT<Part> decomposition(equations.h.topLeftCorner<kCount, kCount>());
    Solution solution;
    solution.inverse.topLeftCorner<kCount, kCount>() = decomposition.solve(Part::Identity());
    solution.step.head<kCount>() = decomposition.solve(equations.g.head<kCount>());
    const Residuals residuals(linearized, solution.step, kCount);
    solution.mean_square = residuals.MeanSquare();
    solution.camera_mean_square = residuals.CameraMeanSquare();
    solution.scatter_variance = residuals.EdgeVariance();
    solution.edge_variance = solution.scatter_variance + more_variance;
    return solution;
  }

  Matrix Covariance() const { return edge_variance * inverse; }
  double Sigma(int unknown) const { return std::sqrt(edge_variance * inverse(unknown, unknown)); }

  Matrix inverse = Matrix::Zero();  // of the equations
  Vector step = Vector::Zero();
  double mean_square;         // mean square of the offsets after the step
  double camera_mean_square;  // the same against the camera's own lens
  double scatter_variance;    // variance of an edge, px^2, from the residuals
  double edge_variance;       // the same plus the additional variance
};

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
  equations.PullToZero(kSpread, state.spread_px, kHeld);
  return Solution::Of<kPoseUnknowns + 1>(linearized, equations);
}

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

// Sets covariance and residuals of the location from a solution.
void PatternLocator::Describe(const Linearized& linearized, const Solution& solution,
                              PatternLocation* location) {
  const Vector blur = kBlurSpreadPx2 * solution.inverse * linearized.by_blur;
  location->covariance = (solution.Covariance() + blur * blur.transpose()).topLeftCorner<6, 6>();
  location->edge_rms_px = std::sqrt(solution.mean_square);
  location->misfit_px = std::sqrt(solution.camera_mean_square);
}

// Adds, when the calibration may be wrong, to the covariance the uncertainty of the pose under a
// free calibration and the distance by which that pose would move.
void PatternLocator::DoubtCalibration(const Solution& held, const Solution& free,
                                      PatternLocation* location) {
  const PoseVector moved = (free.step - held.step).head<kPoseUnknowns>();
  location->covariance += free.Covariance().topLeftCorner<6, 6>() + moved * moved.transpose();
}

std::optional<PatternLocation> PatternLocator::Locate(
    const PrintEdges& found, const RigidTransform& initial,
    const std::optional<NormalPrior>& prior) const {
  const bool is_part = found.IsPart();
  PatternLocation location;
  State state{initial};
  double scale = kFarScalePx;
  if (found.count >= kCoarseEdges * kFewEdges) {
    if (!Approach(EdgeColumns(found, kCoarseEdges), prior, &state, &scale)) return std::nullopt;
  }
  const EdgeColumns edges(found, 1);
  Linearized linearized(edges);
  const int least_steps = scale < kFarScalePx ? 1 : kLeastSteps;
  for (int i = 1; i <= kMaxSteps; ++i) {
    Linearize(state, scale, kUnknowns, &linearized);
    if (linearized.used < kMinEdges) return std::nullopt;
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
  location.camera_from_pattern = state.pose;
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
    if (linearized.used < kMinEdges) return false;
    const Vector step = WithPrior(linearized, *state, prior).PoseStep();
    if (!state->Move(step)) return false;
    *scale_px = linearized.NextScale(*scale_px);
    if (i >= kLeastSteps && linearized.Movement(step) < kSettledPx) break;
  }
  return true;
}

// Solves for the calibration too. Changes state and location where the edges contradict the
// camera's calibration.
void PatternLocator::Recalibrate(const EdgeColumns& edges, const std::optional<NormalPrior>& prior,
                                 State* state, PatternLocation* location) const {
  location->calibration = {};
  State free = *state;
  Linearized linearized(edges);
  double scale = kFarScalePx;
  for (int i = 1; i <= kMaxSteps; ++i) {
    Linearize(free, scale, kUnknowns, &linearized);
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
    scale = linearized.NextScale(scale);
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
  PrintEdges found;
  EdgeColumns edges;
  Linearized linearized(edges);
  const auto measure = [&](std::size_t stride) {
    const PlaneWarp warp(camera_, state.pose, outline_.radius_m());
    FindPrintEdges(image, {}, warp, places, {reach, min_step, stride}, &found);
    edges = EdgeColumns(found, 1);
    Linearize(state, scale, kPoseUnknowns, &linearized);
  };
  for (int i = 0; i < iterations; ++i) {
    measure(kCoarseStride);
    is_whole = linearized.used >= whole;
    if (!is_whole) {
      measure(1);
      is_whole = linearized.used >= kCoarseStride * whole;
    }
    if (linearized.used < kMinEdges) return std::nullopt;
    // A ring does not determine the turn in its plane, and a short arc hardly its far side.
    Matrix& h = linearized.equations.h;
    h.diagonal() *= 1 + 1e-4;
    const double weight = 1e-6 * h.diagonal().segment<3>(3).maxCoeff();
    for (int k = 3; k < 6; ++k) h(k, k) += weight;
    const Vector step = WithPrior(linearized, state, prior).PoseStep();
    if (!state.Move(step)) return std::nullopt;
    const double before =
        std::exchange(scale, std::clamp(linearized.RobustScale(), kLeastScalePx, scale));
    reach = std::clamp(3 * scale, 1.5, reach);
    // Edges of anything but a ring stay scattered.
    const bool gathers = scale < kGathering * before && i + 1 < iterations;
    if (i > 0 && scale > kMaxRingScatterPx && !gathers) return std::nullopt;
    if (i > 0 && linearized.Movement(step) < kRingSettledPx) break;
  }
  return RingLocation{state.pose, is_whole};
}

}  // namespace kestrel
