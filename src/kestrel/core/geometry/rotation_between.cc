// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/geometry/rotation_between.h"

#include <cmath>

namespace kestrel {

Eigen::Quaterniond RotationBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  constexpr double kOpposite = 1e-12;
  const Eigen::Vector3d a = from.normalized();
  const Eigen::Vector3d b = to.normalized();
  const double cosine = b.dot(a);
  Eigen::Quaterniond rotation;
  if (cosine < -1 + kOpposite) {
    rotation.w() = 0;
    rotation.vec() = a.unitOrthogonal();
    return rotation;
  }
  const double scale = std::sqrt((1 + cosine) * 2);  // twice the cosine of half the angle
  rotation.w() = scale * 0.5;
  rotation.vec() = a.cross(b) * (1 / scale);
  return rotation;
}

}  // namespace kestrel
