// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "kestrel/core/poses/pose_history.h"

namespace kestrel {

// Errors of a position in the world besides the detector's error in the image, as standard
// deviations: those that differ from frame to frame, and those that a whole flight shares.
struct MeasurementNoise {
  double pose_sigma_m = 0.01;        // of the UAV's position, per axis
  double attitude_sigma_deg = 0.15;  // of the UAV's attitude, per axis
  double clock_sigma_s = 0;          // of the poses' times, besides PoseSample::time_sigma_s
  double pose_bias_m = 0.03;         // of the UAV's position, per axis, the same in all frames
  double attitude_bias_deg = 0.2;    // of the UAV's attitude and the camera's mount, per axis
  double scale_bias = 0.002;         // of the pattern's size and the focal length, relative

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("pose_sigma_m", self.pose_sigma_m, "m", "noise of the UAV's position, per axis");
    visitor("attitude_sigma_deg", self.attitude_sigma_deg, "deg",
            "noise of the UAV's attitude, per axis");
    visitor("clock_sigma_s", self.clock_sigma_s, "s",
            "error of the poses' times, besides what the autopilot's link is known to cause");
    visitor("pose_bias_m", self.pose_bias_m, "m",
            "error of the UAV's position that all frames share, per axis");
    visitor("attitude_bias_deg", self.attitude_bias_deg, "deg",
            "error of attitude and mount that all frames share, per axis");
    visitor("scale_bias", self.scale_bias, "1",
            "relative error of the pattern's size and of the focal length");
  }
  std::vector<std::string> Validate() const;
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
