// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/pipeline/measurement_noise.h"

#include <numbers>

namespace kestrel {

std::vector<std::string> MeasurementNoise::Validate() const {
  std::vector<std::string> violations;
  const auto require = [&](bool holds, const char* rule) {
    if (!holds) violations.push_back(rule);
  };
  require(pose_sigma_m > 0 && pose_sigma_m < 100, "pose_sigma_m must be positive, below 100");
  require(attitude_sigma_deg >= 0 && attitude_sigma_deg < 90, "attitude_sigma_deg must be 0 to 90");
  require(scale_sigma >= 0 && scale_sigma < 1, "scale_sigma must be 0 to 1");
  return violations;
}

Eigen::Matrix3d CovarianceInWorld(const Eigen::Matrix3d& covariance_in_camera,
                                  const Eigen::Vector3d& center_in_camera,
                                  const Eigen::Quaterniond& world_from_camera,
                                  const MeasurementNoise& noise) {
  const double attitude = noise.attitude_sigma_deg * std::numbers::pi / 180;
  const Eigen::Matrix3d along = center_in_camera * center_in_camera.transpose();
  const Eigen::Matrix3d across =
      center_in_camera.squaredNorm() * Eigen::Matrix3d::Identity() - along;
  const Eigen::Matrix3d in_camera = covariance_in_camera + attitude * attitude * across +
                                    noise.scale_sigma * noise.scale_sigma * along;
  const Eigen::Matrix3d rotation = world_from_camera.toRotationMatrix();
  Eigen::Matrix3d in_world = rotation * in_camera * rotation.transpose();
  in_world.diagonal().array() += noise.pose_sigma_m * noise.pose_sigma_m;
  return 0.5 * (in_world + in_world.transpose());
}

}  // namespace kestrel
