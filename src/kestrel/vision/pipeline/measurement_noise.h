// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/poses/pose_history.h"

namespace kestrel {

// Errors of a position in the world besides the detector's error in the image, as standard
// deviations: those that differ from frame to frame, and those that a whole flight shares.
struct MeasurementNoise {
  double pose_sigma_m = 0.01;
  double attitude_sigma_deg = 0.15;
  double clock_sigma_s = 0;
  double pose_bias_m = 0.03;
  double attitude_bias_deg = 0.2;
  double scale_bias = 0.002;

  static void Visit(auto& self, auto&& visit) {
    visit("pose_sigma_m", self.pose_sigma_m, Between(0, 100),
          "noise of the UAV's position, per axis");
    visit("attitude_sigma_deg", self.attitude_sigma_deg, Range{0, 90, true, false},
          "noise of the UAV's attitude, per axis");
    visit("clock_sigma_s", self.clock_sigma_s, Range{0, 1, true, false},
          "error of the poses' times, besides what the autopilot's link is known to cause");
    visit("pose_bias_m", self.pose_bias_m, Range{0, 100, true, false},
          "error of the UAV's position that all frames share, per axis");
    visit("attitude_bias_deg", self.attitude_bias_deg, Range{0, 90, true, false},
          "error of attitude and mount that all frames share, per axis");
    visit("scale_bias", self.scale_bias, Range{0, 1, true, false},
          "relative error of the pattern's size and of the focal length");
  }
};

// Returns the noise of a frame whose pose is less certain than that of others.
MeasurementNoise WithPose(const MeasurementNoise& noise, const PoseUncertainty& pose);

// Returns the covariance (m^2) of the errors that differ from frame to frame, for a position in the
// world seen at 'center_in_camera' with 'covariance_in_camera'. Without that of the poses'
// times.
Eigen::Matrix3d CovarianceInWorld(const Eigen::Matrix3d& covariance_in_camera,
                                  const Eigen::Vector3d& center_in_camera,
                                  const Eigen::Quaterniond& world_from_camera,
                                  const MeasurementNoise& noise);

// Returns the variance (rad^2) of a yaw in the world, for a pose whose rotation has the given
// covariance in the camera frame (rad^2).
double YawVarianceInWorld(const Eigen::Matrix3d& covariance_in_camera,
                          const Eigen::Quaterniond& world_from_camera,
                          const MeasurementNoise& noise);

// Returns the covariance (m^2) of the errors that the positions of a flight share, for one seen at
// 'center_in_camera'.
Eigen::Matrix3d SharedCovarianceInWorld(const Eigen::Vector3d& center_in_camera,
                                        const Eigen::Quaterniond& world_from_camera,
                                        const MeasurementNoise& noise);

}  // namespace kestrel
