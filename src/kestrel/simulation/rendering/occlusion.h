// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "kestrel/simulation/scene/world.h"

namespace kestrel {

// Whether a surface stands between two points of the world at 'time_s'. What the point itself lies
// on does not hide it.
bool IsHidden(const World& world, double time_s, const Eigen::Vector3d& eye,
              const Eigen::Vector3d& point);

}  // namespace kestrel
