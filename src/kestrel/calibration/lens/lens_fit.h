// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "kestrel/calibration/lens/lens_projection.h"
#include "kestrel/calibration/lens/lens_view.h"
#include "kestrel/core/camera/camera_model.h"

namespace kestrel {

// Which parameters of a lens are estimated; the others keep their values.
struct LensFreedom {
  bool focal = true;
  bool aspect = false;  // fy apart from fx
  bool principal = true;
  int distortion = 0;  // the first so many coefficients

  // fx, fy / fx, cx, cy, coefficients.
  bool IsFree(int parameter) const;
  int count() const;
};

// A lens and the poses of all views, by least squares.
struct LensFit {
  CameraIntrinsics intrinsics;
  LensFreedom freedom;
  // Standard deviations of the parameters (fx, fy / fx, cx, cy, coefficients), by how differently
  // the views pull at them; 0 of those that were not estimated.
  Eigen::Vector<double, kLensParameters> sigmas;
  std::vector<RigidTransform> camera_from_pattern;  // by view
  std::vector<std::vector<double>> residuals_px;    // of each view's edges, across the outline
  double cost = 0;  // robust, half of the squares over the variance of an edge
  // By how much the lens has come nearer to these views than it will to others: trace of the
  // inverse Hessian times the variance of the views' gradients (Takeuchi 1976).
  double optimism = 0;

  double RootMeanSquare() const;  // of the residuals, px

  // The lens without coefficients that were not estimated, as a calibration file has it.
  CameraIntrinsics Simplified() const;
};

// Bundle adjustment: lens and poses (and by how much the black of each print has spread over its
// white) that bring the outlines nearest to the edges across them, from the poses of the views and
// the lens 'start' (of at most five coefficients), with Huber's loss. 'edge_sigma_px': standard
// deviation of an edge. The principal point is held to the middle of the image and, weakly, the
// focal length to that of 'start', so that all has a solution: the standard deviations tell what
// the views do not say. Nothing when the lens cannot show a view.
std::optional<LensFit> FitLens(std::span<const LensView> views, const CameraIntrinsics& start,
                               const LensFreedom& freedom, double edge_sigma_px);

// The standard deviation of an edge by the median of the magnitudes of all residuals.
double RobustSigma(const std::vector<std::vector<double>>& residuals_px);

}  // namespace kestrel
