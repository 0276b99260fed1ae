// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "kestrel/core/base/random.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {

// Unit vectors in the plane: at an angle (rad) to x, and in a random direction.
inline Eigen::Vector2d Direction(double angle) { return {std::cos(angle), std::sin(angle)}; }
inline Eigen::Vector2d RandomDirection(Random* random) {
  return Direction(random->Uniform(0, 2 * kPi));
}

}  // namespace kestrel
