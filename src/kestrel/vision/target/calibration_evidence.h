// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace kestrel {

// Displacement of the outlines, as a share of the ring's diameter, by sheets that are not quite
// flat and by lens errors other than focal length and principal point. Measured on real prints.
inline constexpr double kUnflatShare = 0.004;

// Evidence of one view of a print about the camera's calibration.
struct CalibrationEvidence {
  // Natural logarithm of (true focal length / calibrated focal length), and its standard deviation.
  // The deviations are those of the prior on any calibration when the view says nothing.
  double log_focal = 0;
  double log_focal_sigma = 0.25;
  Eigen::Vector2d principal_px = Eigen::Vector2d::Zero();  // its error in the calibration
  // Squared Mahalanobis distance between these estimates and the calibration: 3 on average where
  // the calibration is right.
  double surprise = 0;
  // True when the calibration as given cannot explain the view. The pose then belongs to the focal
  // length and principal point that do explain it.
  bool contradicts = false;
  // Evidence of the edges alone, without any prior, on four numbers: logarithm of the focal length,
  // principal point (2), and distortion (a point at distance r from the principal point moves by
  // distortion * r^3; lengths in focal lengths). 'information' is the inverse covariance, 'pull' is
  // the information times the estimate. One view leaves some of the numbers open; sum both over
  // views from several sides. Zero where the view says nothing.
  Eigen::Matrix4d information = Eigen::Matrix4d::Zero();
  Eigen::Vector4d pull = Eigen::Vector4d::Zero();
  double edge_variance = 0;  // px^2, variance of one edge that both are computed with
};

}  // namespace kestrel
