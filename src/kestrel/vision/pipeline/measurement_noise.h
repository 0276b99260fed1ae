// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "kestrel/core/poses/pose_history.h"

namespace kestrel {

// What is wrong with a position in the world besides the detector's error in the image: standard
// deviations of what differs from frame to frame, and of what a whole flight has in common.
struct MeasurementNoise {
  double pose_sigma_m = 0.01;        // of the UAV's position, per axis
  double attitude_sigma_deg = 0.15;  // of its attitude, per axis
  double pose_bias_m = 0.03;         // of its position, per axis, in all frames alike
  double attitude_bias_deg = 0.2;    // of its attitude and the camera's mount, per axis
  double scale_bias = 0.002;  // of the pattern's size and the focal length, as a part of them

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("pose_sigma_m", self.pose_sigma_m, "m", "noise of the UAV's position, per axis");
    visitor("attitude_sigma_deg", self.attitude_sigma_deg, "deg",
            "noise of the UAV's attitude, per axis");
    visitor("pose_bias_m", self.pose_bias_m, "m",
            "error of the UAV's position that all frames share, per axis");
    visitor("attitude_bias_deg", self.attitude_bias_deg, "deg",
            "error of attitude and mount that all frames share, per axis");
    visitor("scale_bias", self.scale_bias, "1",
            "error of the pattern's size and the focal length, as a part of them");
  }
  std::vector<std::string> Validate() const;
};

// The noise of a frame whose pose is less sure than others.
MeasurementNoise WithPose(const MeasurementNoise& noise, const PoseUncertainty& pose);

// Covariance (m^2) of what differs from frame to frame in a position in the world that was seen at
// 'center_in_camera' with 'covariance_in_camera'.
Eigen::Matrix3d CovarianceInWorld(const Eigen::Matrix3d& covariance_in_camera,
                                  const Eigen::Vector3d& center_in_camera,
                                  const Eigen::Quaterniond& world_from_camera,
                                  const MeasurementNoise& noise);

// Variance (rad^2) of a yaw in the world, of a pose whose rotation has the given covariance in the
// camera frame (rad^2).
double YawVarianceInWorld(const Eigen::Matrix3d& covariance_in_camera,
                          const Eigen::Quaterniond& world_from_camera,
                          const MeasurementNoise& noise);

// Covariance (m^2) of what the positions of a flight have in common, for one seen at
// 'center_in_camera'.
Eigen::Matrix3d SharedCovarianceInWorld(const Eigen::Vector3d& center_in_camera,
                                        const Eigen::Quaterniond& world_from_camera,
                                        const MeasurementNoise& noise);

}  // namespace kestrel
