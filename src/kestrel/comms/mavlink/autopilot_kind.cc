// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/autopilot_kind.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "kestrel/comms/mavlink/mavlink_enums.h"

namespace kestrel {
namespace {

constexpr std::uint32_t kArduCopterAltHold = 2;
constexpr std::uint32_t kArduCopterGuided = 4;
constexpr std::uint32_t kArduCopterLoiter = 5;
constexpr std::uint32_t kArduCopterReturn = 6;
constexpr std::uint32_t kArduCopterLand = 9;
constexpr std::uint32_t kArduCopterBrake = 17;
constexpr std::uint32_t kArduCopterGuidedNoGps = 20;

constexpr std::array<std::pair<std::uint32_t, std::string_view>, 22> kArduCopterModes = {
    {{0, "STABILIZE"},
     {1, "ACRO"},
     {kArduCopterAltHold, "ALT_HOLD"},
     {3, "AUTO"},
     {kArduCopterGuided, "GUIDED"},
     {kArduCopterLoiter, "LOITER"},
     {kArduCopterReturn, "RTL"},
     {7, "CIRCLE"},
     {kArduCopterLand, "LAND"},
     {11, "DRIFT"},
     {13, "SPORT"},
     {14, "FLIP"},
     {15, "AUTOTUNE"},
     {16, "POSHOLD"},
     {kArduCopterBrake, "BRAKE"},
     {18, "THROW"},
     {kArduCopterGuidedNoGps, "GUIDED_NOGPS"},
     {21, "SMART_RTL"},
     {22, "FLOWHOLD"},
     {23, "FOLLOW"},
     {24, "ZIGZAG"},
     {27, "AUTO_RTL"}}};

constexpr std::uint32_t kPx4Altitude = Px4CustomMode(2, 0);
constexpr std::uint32_t kPx4Position = Px4CustomMode(3, 0);
constexpr std::uint32_t kPx4Loiter = Px4CustomMode(4, 3);
constexpr std::uint32_t kPx4Return = Px4CustomMode(4, 5);
constexpr std::uint32_t kPx4Land = Px4CustomMode(4, 6);
constexpr std::uint32_t kPx4Precland = Px4CustomMode(4, 9);
constexpr std::uint32_t kPx4Offboard = Px4CustomMode(6, 0);

constexpr std::array<std::pair<std::uint32_t, std::string_view>, 29> kPx4Modes = {
    {{Px4CustomMode(1, 0), "MANUAL"},
     {kPx4Altitude, "ALTCTL"},
     {kPx4Position, "POSCTL"},
     {Px4CustomMode(3, 1), "ORBIT"},
     {Px4CustomMode(3, 2), "POSITION_SLOW"},
     {Px4CustomMode(4, 1), "READY"},
     {Px4CustomMode(4, 2), "TAKEOFF"},
     {kPx4Loiter, "LOITER"},
     {Px4CustomMode(4, 4), "MISSION"},
     {kPx4Return, "RTL"},
     {kPx4Land, "LAND"},
     {Px4CustomMode(4, 8), "FOLLOW"},
     {kPx4Precland, "PRECLAND"},
     {Px4CustomMode(4, 10), "VTOL_TAKEOFF"},
     {Px4CustomMode(4, 11), "EXTERNAL1"},
     {Px4CustomMode(4, 12), "EXTERNAL2"},
     {Px4CustomMode(4, 13), "EXTERNAL3"},
     {Px4CustomMode(4, 14), "EXTERNAL4"},
     {Px4CustomMode(4, 15), "EXTERNAL5"},
     {Px4CustomMode(4, 16), "EXTERNAL6"},
     {Px4CustomMode(4, 17), "EXTERNAL7"},
     {Px4CustomMode(4, 18), "EXTERNAL8"},
     {Px4CustomMode(4, 19), "COURSE"},
     {kPx4Descend, "DESCEND"},
     {Px4CustomMode(5, 0), "ACRO"},
     {kPx4Offboard, "OFFBOARD"},
     {Px4CustomMode(7, 0), "STABILIZED"},
     {Px4CustomMode(8, 0), "RATTITUDE"},
     {Px4CustomMode(10, 0), "TERMINATION"}}};

template <class Modes>
std::string NameIn(const Modes& modes, std::uint32_t custom_mode) {
  for (const auto& [mode, name] : modes) {
    if (mode == custom_mode) return std::string(name);
  }
  return fmt::format("#{}", custom_mode);
}

std::uint32_t ArduCopterMode(FlightMode mode) {
  switch (mode) {
    case FlightMode::kGuided:
      return kArduCopterGuided;
    case FlightMode::kGuidedByLean:
      return kArduCopterGuidedNoGps;
    case FlightMode::kLand:
    case FlightMode::kPrecisionLand:
      return kArduCopterLand;
    case FlightMode::kHold:
      return kArduCopterBrake;
    case FlightMode::kPilot:
      return kArduCopterLoiter;
    case FlightMode::kAltitude:
      return kArduCopterAltHold;
    case FlightMode::kReturn:
      return kArduCopterReturn;
  }
  return 0;
}

std::uint32_t Px4Mode(FlightMode mode) {
  switch (mode) {
    case FlightMode::kGuided:
    case FlightMode::kGuidedByLean:
      return kPx4Offboard;
    case FlightMode::kLand:
      return kPx4Land;
    case FlightMode::kPrecisionLand:
      return kPx4Precland;
    case FlightMode::kHold:
      return kPx4Loiter;
    case FlightMode::kPilot:
      return kPx4Position;
    case FlightMode::kAltitude:
      return kPx4Altitude;
    case FlightMode::kReturn:
      return kPx4Return;
  }
  return 0;
}

}  // namespace

const char* ToString(AutopilotKind kind) {
  switch (kind) {
    case AutopilotKind::kUnknown:
      return "unknown";
    case AutopilotKind::kArduPilot:
      return "ArduPilot";
    case AutopilotKind::kPx4:
      return "PX4";
    case AutopilotKind::kOther:
      return "other";
  }
  return "";
}

AutopilotKind AutopilotKindOf(std::uint8_t mav_autopilot) {
  if (mav_autopilot == mavlink::kAutopilotArduPilot) return AutopilotKind::kArduPilot;
  if (mav_autopilot == mavlink::kAutopilotPx4) return AutopilotKind::kPx4;
  return AutopilotKind::kOther;
}

bool IsMulticopter(std::uint8_t mav_type) {
  constexpr std::array<std::uint8_t, 8> kTypes = {
      mavlink::kTypeQuadrotor,   mavlink::kTypeCoaxial,   mavlink::kTypeHelicopter,
      mavlink::kTypeHexarotor,   mavlink::kTypeOctorotor, mavlink::kTypeTricopter,
      mavlink::kTypeDodecarotor, mavlink::kTypeDecarotor};
  return std::find(kTypes.begin(), kTypes.end(), mav_type) != kTypes.end();
}

const char* VehicleName(std::uint8_t mav_type) {
  if (IsMulticopter(mav_type)) return "a multicopter";
  if (mav_type >= mavlink::kTypeVtolFirst && mav_type <= mavlink::kTypeVtolLast) return "a VTOL";
  switch (mav_type) {
    case mavlink::kTypeFixedWing:
      return "a plane";
    case mavlink::kTypeGroundRover:
      return "a rover";
    case mavlink::kTypeSurfaceBoat:
      return "a boat";
    case mavlink::kTypeSubmarine:
      return "a submarine";
    default:
      return "no multicopter";
  }
}

std::uint32_t CustomModeOf(AutopilotKind kind, FlightMode mode) {
  if (kind == AutopilotKind::kArduPilot) return ArduCopterMode(mode);
  return kind == AutopilotKind::kPx4 ? Px4Mode(mode) : 0;
}

std::string ModeName(AutopilotKind kind, std::uint32_t custom_mode) {
  if (kind == AutopilotKind::kArduPilot) return NameIn(kArduCopterModes, custom_mode);
  if (kind == AutopilotKind::kPx4) return NameIn(kPx4Modes, custom_mode);
  return fmt::format("#{}", custom_mode);
}

bool IsLandingMode(AutopilotKind kind, std::uint32_t custom_mode) {
  if (kind == AutopilotKind::kArduPilot) return custom_mode == kArduCopterLand;
  return kind == AutopilotKind::kPx4 && (custom_mode == kPx4Land || custom_mode == kPx4Precland);
}

bool IsDescent(AutopilotKind kind, std::uint32_t custom_mode) {
  return custom_mode == CustomModeOf(kind, FlightMode::kLand) ||
         (kind == AutopilotKind::kPx4 && custom_mode == kPx4Descend);
}

bool IsGuidedMode(AutopilotKind kind, std::uint32_t custom_mode) {
  if (kind == AutopilotKind::kArduPilot) return custom_mode == kArduCopterGuided;
  return kind == AutopilotKind::kPx4 && custom_mode == kPx4Offboard;
}

bool IsGuidedByLeanMode(AutopilotKind kind, std::uint32_t custom_mode) {
  if (kind == AutopilotKind::kArduPilot) return custom_mode == kArduCopterGuidedNoGps;
  return IsGuidedMode(kind, custom_mode);
}

}  // namespace kestrel
