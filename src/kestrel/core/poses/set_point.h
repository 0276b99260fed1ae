// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>

namespace kestrel {

// What an autopilot that is guided from outside is told, in the world (ENU): a velocity (m/s), the
// acceleration (m/s^2) that will be needed to keep up with it, and where the nose points (rad from
// east to north; nothing: where it points now).
struct SetPoint {
  Eigen::Vector3d velocity{0, 0, 0};
  Eigen::Vector3d acceleration{0, 0, 0};
  std::optional<double> yaw = std::nullopt;
};

}  // namespace kestrel
