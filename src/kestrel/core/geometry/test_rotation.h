// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

namespace kestrel {

// Returns the rotation by 'angle' (rad) about an axis of any length.
inline Eigen::Quaterniond Rotation(double angle, const Eigen::Vector3d& axis) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis.normalized()));
}

}  // namespace kestrel
