// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "kestrel/comms/mavlink/autopilot_kind.h"

namespace kestrel {

// A place on the Earth as MAVLink tells it.
struct GlobalPosition {
  std::int32_t latitude_e7 = 0;   // 1e-7 degrees
  std::int32_t longitude_e7 = 0;  // 1e-7 degrees
  double altitude_m = 0;          // above mean sea level
};

// 'position' in the world (ENU) that has its origin at 'origin', as this autopilot computes it:
// each has a radius of the Earth of its own. To the millimetre up to a kilometre away.
Eigen::Vector3d LocalFromGlobal(AutopilotKind kind, const GlobalPosition& origin,
                                const GlobalPosition& position);
GlobalPosition GlobalFromLocal(AutopilotKind kind, const GlobalPosition& origin,
                               const Eigen::Vector3d& in_world);

}  // namespace kestrel
