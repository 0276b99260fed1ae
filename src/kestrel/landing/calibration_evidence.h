// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace kestrel {

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
};

}  // namespace kestrel
