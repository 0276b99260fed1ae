// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/mount/pose_smoothing.h"

#include <span>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace kestrel {
namespace {

constexpr std::size_t kMinSamples = 6;  // for a parabola that does not just pass through them

// Returns the pose at the time of 'at' by the parabolas through 'window', which reaches at most
// 'half_window_s' from there. Solves the normal equations.
RigidTransform FitAt(const PoseSample& at, std::span<const PoseSample> window,
                     double half_window_s) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 3, 6> sums = Eigen::Matrix<double, 3, 6>::Zero();
  for (const PoseSample& sample : window) {
    const double t = ToSeconds(sample.time - at.time) / half_window_s;
    const Eigen::Vector3d powers(1, t, t * t);
    const RigidTransform offset = at.world_from_body.Inverse() * sample.world_from_body;
    normal += powers * powers.transpose();
    sums.leftCols<3>() += powers * offset.translation.transpose();
    sums.rightCols<3>() += powers * RotationVector(offset.rotation).transpose();
  }
  const Eigen::Matrix<double, 6, 1> now = sums.transpose() * normal.inverse().row(0).transpose();
  const RigidTransform correction{RotationBy(now.tail<3>()), now.head<3>()};
  RigidTransform pose = at.world_from_body * correction;
  pose.rotation.normalize();
  return pose;
}

}  // namespace

std::vector<PoseSample> SmoothPoses(const std::vector<PoseSample>& samples, Duration half_window) {
  std::vector<PoseSample> smooth = samples;
  std::size_t begin = 0;
  std::size_t end = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    while (samples[begin].time < samples[i].time - half_window) ++begin;
    while (end < samples.size() && samples[end].time <= samples[i].time + half_window) ++end;
    if (end - begin < kMinSamples) continue;
    smooth[i].world_from_body =
        FitAt(samples[i], std::span(samples).subspan(begin, end - begin), ToSeconds(half_window));
  }
  return smooth;
}

}  // namespace kestrel
