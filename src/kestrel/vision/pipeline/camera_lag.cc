// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/camera_lag.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace kestrel {

void CameraLag::Add(const Eigen::Vector3d& offset_m, const Eigen::Vector3d& slip_mps,
                    const Eigen::Matrix3d& covariance) {
  constexpr double kLeastSigma_s = 0.005;  // mounts that are slightly wrong look like a lag, too
  const Eigen::Vector3d gain = sigma_s_ * sigma_s_ * covariance.llt().solve(slip_mps);
  if (!gain.allFinite()) return;
  lag_s_ = std::clamp(lag_s_ + gain.dot(offset_m), -kLongest_s, kLongest_s);
  const double left = std::max(1 - gain.dot(slip_mps), 0.0);
  sigma_s_ = std::max(sigma_s_ * std::sqrt(left), kLeastSigma_s);
}

}  // namespace kestrel
