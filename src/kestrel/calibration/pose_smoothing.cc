// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/pose_smoothing.h"

#include <span>

#include <Eigen/Dense>

namespace kestrel {
namespace {

constexpr std::size_t kMinSamples = 6;  // for a parabola that is not the samples themselves

// The pose at the time of 'at' by the parabolas through 'window'.
RigidTransform FitAt(const PoseSample& at, std::span<const PoseSample> window) {
  const auto count = static_cast<Eigen::Index>(window.size());
  Eigen::MatrixX3d basis(count, 3);
  Eigen::Matrix<double, Eigen::Dynamic, 6> offsets(count, 6);  // from the pose of 'at'
  for (Eigen::Index i = 0; i < count; ++i) {
    const PoseSample& sample = window[static_cast<std::size_t>(i)];
    const double t = ToSeconds(sample.time - at.time);
    const RigidTransform offset = at.world_from_body.Inverse() * sample.world_from_body;
    basis.row(i) << 1, t, t * t;
    offsets.row(i) << offset.translation.transpose(), RotationVector(offset.rotation).transpose();
  }
  const Eigen::Matrix<double, 3, 6> parabolas = basis.colPivHouseholderQr().solve(offsets);
  const Eigen::Matrix<double, 6, 1> now = parabolas.row(0).transpose();
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
    smooth[i].world_from_body = FitAt(samples[i], std::span(samples).subspan(begin, end - begin));
  }
  return smooth;
}

}  // namespace kestrel
