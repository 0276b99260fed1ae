// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/gimbal_bias.h"

#include <cmath>

#include <Eigen/Cholesky>

namespace kestrel {
namespace {

// Errors of reports and stamps last longer than a frame.
constexpr Duration kPeriod = std::chrono::milliseconds(200);
constexpr double kMostTurn_radps = 0.1;  // a late stamp would pass for an angle
constexpr double kLongestGap_s = 60;
constexpr double kDrift = 2e-4;  // of the angles, rad in the square root of a second

Eigen::Matrix3d CrossMatrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d matrix;
  matrix << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return matrix;
}

Eigen::Quaterniond TurnBy(const Eigen::Vector3d& angles) {
  const double angle = angles.norm();
  if (angle == 0) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, angles / angle));
}

}  // namespace

Eigen::Quaterniond GimbalBias::Add(const Sight& sight) {
  const double past_s = newest_ ? ToSeconds(sight.time - newest_->time) : kLongestGap_s;
  if (newest_ && past_s < ToSeconds(kPeriod)) return Eigen::Quaterniond::Identity();
  if (past_s >= kLongestGap_s) {
    Begin(sight);
    return Eigen::Quaterniond::Identity();
  }
  const bool is_turning = IsTurning(sight);
  newest_ = sight;
  constexpr double kMinute_s = 60;
  covariance_.topLeftCorner<3, 3>().diagonal().array() +=
      sight.wander_m * sight.wander_m * past_s / kMinute_s;
  covariance_.bottomRightCorner<3, 3>().diagonal().array() += kDrift * kDrift * past_s;
  if (is_turning) return Eigen::Quaterniond::Identity();
  Eigen::Matrix<double, 3, 6> by_state;
  by_state << Eigen::Matrix3d::Identity(),
      sight.world_from_camera.toRotationMatrix() * CrossMatrix(sight.center_in_camera);
  const Eigen::Matrix<double, 6, 3> shared = covariance_ * by_state.transpose();
  const Eigen::Matrix3d innovation = by_state * shared + sight.covariance;
  const Eigen::Matrix<double, 6, 3> gain = innovation.llt().solve(shared.transpose()).transpose();
  const State change = gain * (sight.center_in_world - place_);
  if (!change.allFinite()) return Eigen::Quaterniond::Identity();
  covariance_ -= gain * shared.transpose();
  covariance_ = 0.5 * (covariance_ + covariance_.transpose()).eval();
  place_ += change.head<3>();
  return TurnBy(change.tail<3>());
}

void GimbalBias::Begin(const Sight& sight) {
  newest_ = sight;
  place_ = sight.center_in_world;
  // The place is where these angles put it: it shares their error.
  Eigen::Matrix<double, 3, 3> by_angles =
      -sight.world_from_camera.toRotationMatrix() * CrossMatrix(sight.center_in_camera);
  const Eigen::Matrix3d angles = covariance_.bottomRightCorner<3, 3>();
  covariance_.topRightCorner<3, 3>() = by_angles * angles;
  covariance_.bottomLeftCorner<3, 3>() = angles * by_angles.transpose();
  covariance_.topLeftCorner<3, 3>() = by_angles * angles * by_angles.transpose() + sight.covariance;
}

bool GimbalBias::IsTurning(const Sight& sight) const {
  const double angle = newest_->world_from_camera.angularDistance(sight.world_from_camera);
  return angle > kMostTurn_radps * ToSeconds(sight.time - newest_->time);
}

Eigen::Vector3d GimbalBias::sigma_rad() const {
  return covariance_.bottomRightCorner<3, 3>().diagonal().cwiseSqrt();
}

}  // namespace kestrel
