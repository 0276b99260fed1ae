// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace kestrel {

// Estimates how much later than the other cameras' a camera's images are stamped. Cameras that are
// not synchronised by hardware differ by some tens of milliseconds, and where their views sweep
// over a target that moves differently, they then show it at different places.
class CameraLag {
 public:
  static constexpr double kPrior_s = 0.03;  // standard deviation before the first sighting
  static constexpr double kLongest_s = 3 * kPrior_s;  // a longer one is a fault

  // Takes a sighting. 'offset_m': from where the other cameras see the target, with the present
  // estimate already taken off; 'covariance': of that offset (m^2), with the lag's part;
  // 'slip_mps': offset for each second of the lag.
  void Add(const Eigen::Vector3d& offset_m, const Eigen::Vector3d& slip_mps,
           const Eigen::Matrix3d& covariance);

  double seconds() const { return lag_s_; }
  double sigma_s() const { return sigma_s_; }

 private:
  double lag_s_ = 0;
  double sigma_s_ = kPrior_s;
};

}  // namespace kestrel
