// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace kestrel {

// By how much of the ring's diameter the edges of a print that is not quite flat, or the lens
// beside focal length and principal point, move the outlines: as seen on real prints.
inline constexpr double kUnflatShare = 0.004;

// What one view of a print says about the camera's calibration.
struct CalibrationEvidence {
  // Logarithm of the factor by which the focal length is larger than the calibration's, and its
  // standard deviation: that of what one expects of any calibration where the view says nothing.
  double log_focal = 0;
  double log_focal_sigma = 0.25;
  Eigen::Vector2d principal_px = Eigen::Vector2d::Zero();  // by which the principal point is off
  // Square of how far both are from the calibration's, in their covariance: 3 on average where the
  // calibration is right.
  double surprise = 0;
  // The view cannot be explained with the calibration as it is: what was located, was so with a
  // focal length and a principal point that explain it.
  bool contradicts = false;
  // What the edges alone say, whatever one expects, of the logarithm, the principal point and the
  // distortion (by which the cube of the distance from the principal point moves a point; all in
  // focal lengths): the inverse of their covariance, and that times what they are. A view leaves
  // some of them open: views from several sides are to be added up. Zero where it says nothing.
  Eigen::Matrix4d information = Eigen::Matrix4d::Zero();
  Eigen::Vector4d pull = Eigen::Vector4d::Zero();
  double edge_variance = 0;  // px^2, of an edge: what both are by
};

}  // namespace kestrel
