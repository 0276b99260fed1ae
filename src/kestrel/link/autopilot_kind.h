// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace kestrel {

enum class AutopilotKind { kUnknown, kArduPilot, kPx4, kOther };
const char* ToString(AutopilotKind kind);  // "unknown", "ArduPilot", "PX4", "other"

// Of MAVLink's MAV_AUTOPILOT.
AutopilotKind AutopilotKindOf(std::uint8_t mav_autopilot);

// What the autopilot's pilots call a mode of HEARTBEAT.custom_mode ("LAND", "PRECLAND"), of
// ArduCopter and PX4; its number where it has no name here.
std::string ModeName(AutopilotKind kind, std::uint32_t custom_mode);

// Modes in which the autopilot descends onto a landing target that it is told of.
bool IsLandingMode(AutopilotKind kind, std::uint32_t custom_mode);

}  // namespace kestrel
