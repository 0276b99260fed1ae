// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "kestrel/calibration/lens/lens_view.h"
#include "kestrel/core/camera/camera_model.h"

namespace kestrel {

// The parameters of a lens in the order of the estimation: fx, fy / fx, cx, cy, and the distortion
// coefficients as in CameraIntrinsics, at most five.
enum LensParameter { kFocal, kAspect, kPrincipalX, kPrincipalY, kDistortion, kLensParameters = 9 };

// The parameters of a lens that are estimated; the others keep their values.
struct LensFreedom {
  bool focal = true;
  bool aspect = false;  // fy independent of fx
  bool principal = true;
  int distortion = 0;  // number of coefficients, from the first

  // 'parameter': index in fx, fy / fx, cx, cy, coefficients.
  bool IsFree(int parameter) const;
  int count() const;
};

// A lens and the poses of all views, estimated by least squares.
struct LensFit {
  CameraIntrinsics intrinsics;
  LensFreedom freedom;
  // Standard deviations of the parameters (fx, fy / fx, cx, cy, coefficients), from the scatter of
  // the views' gradients; 0 for those that were not estimated.
  Eigen::Vector<double, kLensParameters> sigmas;
  std::vector<RigidTransform> camera_from_target;  // for each view
  std::vector<std::vector<double>> residuals_px;   // for each view's edges, across the outline
  double cost = 0;  // robust: half of the squared residuals over the variance of an edge
  // Amount by which the fit to these views is better than the fit to others will be: trace of the
  // inverse Hessian times the variance of the views' gradients (Takeuchi 1976).
  double optimism = 0;

  double RootMeanSquare() const;  // RMS of the residuals, px

  // Returns the lens without the coefficients that were not estimated, for a calibration file.
  CameraIntrinsics Simplified() const;
};

// Bundle adjustment. Estimates the lens, the poses and for each print how far its black has spread
// over the white, so that the outlines come nearest to the edges, measured across them, with
// Huber's loss. It starts from the poses of the views and the lens 'start' (with at most five
// coefficients). 'edge_sigma_px': standard deviation of an edge. Priors hold the principal point to
// the middle of the image and, weakly, the focal length to that of 'start', so that there always is
// a solution; the standard deviations show what the views do not determine. Returns nothing when
// the lens cannot show a view.
std::optional<LensFit> FitLens(std::span<const LensView> views, const CameraIntrinsics& start,
                               const LensFreedom& freedom, double edge_sigma_px);

// Returns the standard deviation of an edge, from the median magnitude of all residuals.
double RobustSigma(const std::vector<std::vector<double>>& residuals_px);

}  // namespace kestrel
