// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace kestrel {

// What an autopilot is told: a velocity, and the acceleration that will be needed to keep up with
// it.
struct VelocityCommand {
  Eigen::Vector3d velocity{0, 0, 0};
  Eigen::Vector3d acceleration{0, 0, 0};
};

}  // namespace kestrel
