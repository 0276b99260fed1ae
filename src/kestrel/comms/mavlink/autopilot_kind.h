// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace kestrel {

enum class AutopilotKind { kUnknown, kArduPilot, kPx4, kOther };
const char* ToString(AutopilotKind kind);  // "unknown", "ArduPilot", "PX4", "other"

// Of MAVLink's MAV_AUTOPILOT.
AutopilotKind AutopilotKindOf(std::uint8_t mav_autopilot);

// Of MAVLink's MAV_TYPE: whether it hovers on rotors alone, and what it is in words ("a plane").
bool IsMulticopter(std::uint8_t mav_type);
const char* VehicleName(std::uint8_t mav_type);

// Modes that an autopilot is asked for.
enum class FlightMode {
  kGuided,         // flies by set-points: GUIDED, OFFBOARD
  kLand,           // straight down: LAND
  kPrecisionLand,  // down onto the target that it is told of: LAND, PRECLAND
  kHold,           // stays where it is without a pilot: BRAKE, LOITER ("Hold")
  kPilot,          // the pilot's sticks say where: LOITER, POSCTL
  kReturn,         // RTL
};

// HEARTBEAT.custom_mode of ArduCopter or of PX4; 0 for autopilots of other kinds.
std::uint32_t CustomModeOf(AutopilotKind kind, FlightMode mode);

// PX4's custom_mode of a main mode and, of its automatic ones, which of them.
constexpr std::uint32_t Px4CustomMode(std::uint32_t main, std::uint32_t sub) {
  return main << 16 | sub << 24;
}

// What the autopilot's pilots call a mode of HEARTBEAT.custom_mode ("LAND", "PRECLAND"), of
// ArduCopter and PX4; its number where it has no name here.
std::string ModeName(AutopilotKind kind, std::uint32_t custom_mode);

// Modes in which the autopilot descends onto a landing target that it is told of.
bool IsLandingMode(AutopilotKind kind, std::uint32_t custom_mode);

// The mode in which it flies by set-points from outside.
bool IsGuidedMode(AutopilotKind kind, std::uint32_t custom_mode);

}  // namespace kestrel
