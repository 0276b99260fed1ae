// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "kestrel/simulation/scene/world.h"

namespace kestrel {

// True when a surface stands between 'eye' and 'point' (in the world) at 'time_s'. The surface on
// which the point lies does not count.
bool IsHidden(const World& world, double time_s, const Eigen::Vector3d& eye,
              const Eigen::Vector3d& point);

}  // namespace kestrel
