// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/measurement_noise.h"

#include <cmath>

#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

// Covariance of a position at 'center' due to errors of the attitude (degrees per axis) and of the
// scale (relative), in the camera's axes.
Eigen::Matrix3d SwingAndScale(const Eigen::Vector3d& center, double attitude_deg, double scale) {
  const double attitude = Radians(attitude_deg);
  const Eigen::Matrix3d along = center * center.transpose();
  const Eigen::Matrix3d across = center.squaredNorm() * Eigen::Matrix3d::Identity() - along;
  return attitude * attitude * across + scale * scale * along;
}

Eigen::Matrix3d InWorld(const Eigen::Matrix3d& in_camera, const Eigen::Quaterniond& rotation,
                        double position_sigma_m) {
  const Eigen::Matrix3d world_from_camera = rotation.toRotationMatrix();
  Eigen::Matrix3d in_world = world_from_camera * in_camera * world_from_camera.transpose();
  in_world.diagonal().array() += position_sigma_m * position_sigma_m;
  return 0.5 * (in_world + in_world.transpose());
}

}  // namespace

MeasurementNoise WithPose(const MeasurementNoise& noise, const PoseUncertainty& pose) {
  MeasurementNoise sum = noise;
  sum.pose_sigma_m = std::hypot(noise.pose_sigma_m, pose.position_m);
  sum.attitude_sigma_deg = std::hypot(noise.attitude_sigma_deg, Degrees(pose.attitude_rad));
  return sum;
}

Eigen::Matrix3d CovarianceInWorld(const Eigen::Matrix3d& covariance_in_camera,
                                  const Eigen::Vector3d& center_in_camera,
                                  const Eigen::Quaterniond& world_from_camera,
                                  const MeasurementNoise& noise) {
  const Eigen::Matrix3d swing = SwingAndScale(center_in_camera, noise.attitude_sigma_deg, 0);
  return InWorld(covariance_in_camera + swing, world_from_camera, noise.pose_sigma_m);
}

double YawVarianceInWorld(const Eigen::Matrix3d& covariance_in_camera,
                          const Eigen::Quaterniond& world_from_camera,
                          const MeasurementNoise& noise) {
  const Eigen::Vector3d up = world_from_camera.conjugate() * Eigen::Vector3d::UnitZ();
  const double attitude = Radians(noise.attitude_sigma_deg);
  return up.dot(covariance_in_camera * up) + attitude * attitude;
}

Eigen::Matrix3d SharedCovarianceInWorld(const Eigen::Vector3d& center_in_camera,
                                        const Eigen::Quaterniond& world_from_camera,
                                        const MeasurementNoise& noise) {
  return InWorld(SwingAndScale(center_in_camera, noise.attitude_bias_deg, noise.scale_bias),
                 world_from_camera, noise.pose_bias_m);
}

}  // namespace kestrel
