// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>

namespace kestrel {

// Command for an autopilot under external guidance, in the world (ENU): a velocity (m/s), the
// acceleration (m/s^2) needed to follow it, and the yaw of the nose (rad from east to north;
// nothing: the current yaw), which may turn at a rate (rad/s). With a place (m) the autopilot is
// sent to the place instead of being given the velocity; the velocity is then the one with which
// its position control sets out.
struct SetPoint {
  Eigen::Vector3d velocity{0, 0, 0};
  Eigen::Vector3d acceleration{0, 0, 0};
  std::optional<double> yaw = std::nullopt;
  std::optional<double> yaw_rate = std::nullopt;  // at which 'yaw' changes
  std::optional<Eigen::Vector3d> place = std::nullopt;
  // The UAV stands on a deck that carries it: its horizontal motion is not to be controlled.
  bool is_carried = false;
};

}  // namespace kestrel
