// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include <Eigen/Core>

#include "kestrel/comms/mavlink/autopilot_kind.h"

namespace kestrel {

// A position on the Earth in the form of MAVLink.
struct GlobalPosition {
  std::int32_t latitude_e7 = 0;   // 1e-7 degrees
  std::int32_t longitude_e7 = 0;  // 1e-7 degrees
  double altitude_m = 0;          // above mean sea level
};

// Returns 'position' in the world (ENU) with its origin at 'origin', m, as this kind of autopilot
// computes it: each uses another radius of the Earth. Exact to the millimetre up to a kilometre
// away.
Eigen::Vector3d LocalFromGlobal(AutopilotKind kind, const GlobalPosition& origin,
                                const GlobalPosition& position);
GlobalPosition GlobalFromLocal(AutopilotKind kind, const GlobalPosition& origin,
                               const Eigen::Vector3d& in_world);

// Parses "LATITUDE,LONGITUDE" in degrees; nothing: it is something else, or 0,0.
std::optional<GlobalPosition> ParseGlobalPosition(std::string_view text);

}  // namespace kestrel
