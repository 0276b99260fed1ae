// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace kestrel {

enum class AutopilotKind { kUnknown, kArduPilot, kPx4, kOther };
const char* ToString(AutopilotKind kind);  // "unknown", "ArduPilot", "PX4", "other"

// Returns the kind of a MAV_AUTOPILOT.
AutopilotKind AutopilotKindOf(std::uint8_t mav_autopilot);

// Properties of a MAV_TYPE: whether it flies on rotors alone, and its name ("a plane").
bool IsMulticopter(std::uint8_t mav_type);
const char* VehicleName(std::uint8_t mav_type);

// Modes that can be requested from an autopilot.
enum class FlightMode {
  kGuided,         // flies by set-points: GUIDED, OFFBOARD
  kGuidedByLean,   // flies by lean and climb, without a position: GUIDED_NOGPS, OFFBOARD
  kLand,           // straight down: LAND
  kPrecisionLand,  // descends onto the reported target: LAND, PRECLAND
  kHold,           // holds its place without a pilot: BRAKE, LOITER ("Hold")
  kPilot,          // follows the pilot's sticks: LOITER, POSCTL
  kAltitude,       // likewise, without a position: ALT_HOLD, ALTCTL
  kReturn,         // RTL
};

// HEARTBEAT.custom_mode of ArduCopter or of PX4; 0 for autopilots of other kinds.
std::uint32_t CustomModeOf(AutopilotKind kind, FlightMode mode);

// PX4's custom_mode from its main mode and, for the automatic modes, its sub-mode.
constexpr std::uint32_t Px4CustomMode(std::uint32_t main, std::uint32_t sub) {
  return main << 16 | sub << 24;
}
// PX4 reports this mode when it descends without a position: in its failsafe, and when LAND is
// given.
constexpr std::uint32_t kPx4Descend = Px4CustomMode(4, 20);

// Returns the usual name of a mode of HEARTBEAT.custom_mode ("LAND", "PRECLAND") of ArduCopter and
// PX4; its number where it has no name here.
std::string ModeName(AutopilotKind kind, std::uint32_t custom_mode);

// True for modes in which the autopilot descends onto a reported landing target.
bool IsLandingMode(AutopilotKind kind, std::uint32_t custom_mode);
// True for modes in which it descends where it is: LAND, and PX4's without a position.
bool IsDescent(AutopilotKind kind, std::uint32_t custom_mode);

// True for the mode in which it flies by external set-points.
bool IsGuidedMode(AutopilotKind kind, std::uint32_t custom_mode);
// The same for set-points that need no position.
bool IsGuidedByLeanMode(AutopilotKind kind, std::uint32_t custom_mode);

}  // namespace kestrel
