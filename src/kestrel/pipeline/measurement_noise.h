// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace kestrel {

// What is wrong with a position in the world besides the detector's error in the image: standard
// deviations.
struct MeasurementNoise {
  double pose_sigma_m = 0.02;       // of the UAV's position, per axis
  double attitude_sigma_deg = 0.2;  // of its attitude, per axis
  double scale_sigma = 0.005;       // of the pattern's size and the focal length, as a part of them

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("pose_sigma_m", self.pose_sigma_m, "m", "error of the UAV's position, per axis");
    visitor("attitude_sigma_deg", self.attitude_sigma_deg, "deg",
            "error of the UAV's attitude, per axis");
    visitor("scale_sigma", self.scale_sigma, "1",
            "error of the pattern's size and the focal length, as a part of them");
  }
  std::vector<std::string> Validate() const;
};

// Covariance (m^2) of a position in the world that was seen at 'center_in_camera' with
// 'covariance_in_camera'.
Eigen::Matrix3d CovarianceInWorld(const Eigen::Matrix3d& covariance_in_camera,
                                  const Eigen::Vector3d& center_in_camera,
                                  const Eigen::Quaterniond& world_from_camera,
                                  const MeasurementNoise& noise);

}  // namespace kestrel
