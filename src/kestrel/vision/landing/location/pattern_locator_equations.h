// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The equations of PatternLocator: what its sources share.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "kestrel/vision/landing/location/neighbor_correlation.h"
#include "kestrel/vision/landing/location/pattern_locator.h"

namespace kestrel {

// Predicts where the outlines are in the image.
struct PatternLocator::State {
  RigidTransform pose;
  double spread_px = 0;  // spread of the black over the white at every edge
  double log_focal = 0;
  Eigen::Vector2d principal_px = Eigen::Vector2d::Zero();

  // Converts a pixel of the camera's own lens to the pixel under the state's calibration.
  Eigen::Vector2d Recalibrated(const Eigen::Vector2d& pixel,
                               const Eigen::Vector2d& principal) const {
    return principal + principal_px + std::exp(log_focal) * (pixel - principal);
  }

  // Changes the unknowns by a step; false when the step is too large.
  bool Move(const Vector& step) {
    const Eigen::Vector3d turn = step.segment<3>(kPoseRotation);
    if (!step.allFinite() || turn.norm() > 1) return false;
    pose = Moved(pose, step.segment<3>(kPoseTranslation), turn);
    spread_px += step(kSpread);
    log_focal += step(kFocal);
    principal_px += step.segment<2>(kPrincipal);
    return true;
  }
};

// Normal equations of a step.
struct PatternLocator::Equations {
  Matrix h = Matrix::Zero();
  Vector g = Vector::Zero();

  static constexpr double kHeld = 1e6;  // weight, in edges, that holds an unknown in place

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
    PullToZero(kPrincipal, state.principal_px.x(), principal_weight);
    PullToZero(kPrincipal + 1, state.principal_px.y(), principal_weight);
    PullToZero(kDistortion, 0, kHeld);
  }
};

// Every stride-th edge, by columns.
struct PatternLocator::EdgeColumns {
  EdgeColumns() = default;
  EdgeColumns(const PrintEdges& found, std::size_t stride);

  std::size_t count = 0;
  Column x_m, y_m;            // place on the print
  Column across_x, across_y;  // normal of the outline in the image
  Column x_px, y_px;
  Column bend;
  std::array<int, PrintOutline::kMaxPlaces> stretch;  // index of the part and side
  std::array<bool, PrintOutline::kMaxPlaces> follows;
};

// The map from a pixel of the camera's own lens to one of the state's calibration.
struct PatternLocator::Lens {
  Eigen::Vector2f principal;  // px, of the camera
  Eigen::Vector2f shown;      // px, where the state has it
  float zoom;                 // factor of the focal length
  float per_focal_squared;    // 1/px^2
};

// The places of the edges under a pose.
struct PatternLocator::Outlines {
  std::array<Column, 3> from_center;  // camera frame, m
  Column x_px, y_px;               // through the camera's own lens; NaN where it does not show it
  std::array<Column, 6> by_point;  // derivatives of x_px, then y_px, by the point
};

// The edges relative to a state, and the normal equations of a step.
struct PatternLocator::Linearized {
  explicit Linearized(const EdgeColumns& of) : edges(of) {}

  // Sets offsets, shifts and the columns of the calibration, with Tukey's weights at the scale
  // 'scale_px'.
  void Compare(const Lens& lens, const Outlines& outlines, float spread_px, double scale_px);
  // Completes the columns. Points that the lens does not show get derivatives of 0.
  void Differentiate(const Lens& lens, Outlines* outlines);
  // Sums the columns to the normal equations of the first 'unknowns'.
  void Sum(int unknowns);

  // Standard deviation of the offsets from the median of their magnitudes.
  double RobustScale() const;
  // Returns the scale of the offsets for the next step, given 'scale_px' of this one.
  double NextScale(double scale_px) const;
  // Returns the motion of the outlines in the image by 'step' (px, root mean square).
  double Movement(const Vector& step) const;

  static constexpr double kFarScalePx = 1000;     // scale of the offsets in the first step
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
  Residuals(const Linearized& linearized, const Vector& step, int unknowns);

  double MeanSquare() const { return weighted_squares / weights; }
  // The same for residuals against the camera's own lens.
  double CameraMeanSquare() const { return camera_squares / weights; }
  // Variance of an edge as the pose sees it. Errors that neighbours share do not average out, and
  // errors that whole stretches of an outline share show in the differences of their means.
  double EdgeVariance() const;

  struct Stretch {
    double sum = 0;  // sum of weighted residuals
    double weights = 0;
  };
  double used;
  double weights;
  double weighted_squares = 0;
  double camera_squares = 0;
  NeighborCorrelation neighbors;
  std::array<Stretch, 2 * PrintOutline::kParts> outline{};  // by part and side
};

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

  Matrix inverse = Matrix::Zero();  // inverse of the equations' matrix
  Vector step = Vector::Zero();
  double mean_square;         // mean square of the offsets after the step
  double camera_mean_square;  // the same against the camera's own lens
  double scatter_variance;    // variance of an edge, px^2, from the residuals
  double edge_variance;       // the same plus the additional variance
};

}  // namespace kestrel
