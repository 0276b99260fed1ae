// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

namespace kestrel {

// Returns the shortest rotation that turns the direction 'from' to the direction 'to'; about any
// axis between opposite ones. Neither may be zero. Eigen's own FromTwoVectors brings a singular
// value decomposition for opposite directions, which takes seconds to compile.
Eigen::Quaterniond RotationBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace kestrel
