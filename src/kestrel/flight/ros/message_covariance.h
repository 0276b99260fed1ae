// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include <Eigen/Core>

#include "kestrel/core/geometry/angles.h"

namespace kestrel {

// Order of ROS: x, y, z, and rotations about x, y, z.
using MessageCovariance = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;

// Variance of an unknown angle, rad^2.
inline constexpr double kUnknownAngleVariance = kPi * kPi / 3;

inline std::array<double, 36> NumbersOf(const MessageCovariance& covariance) {
  std::array<double, 36> numbers;
  Eigen::Map<MessageCovariance>(numbers.data()) = covariance;
  return numbers;
}

}  // namespace kestrel
