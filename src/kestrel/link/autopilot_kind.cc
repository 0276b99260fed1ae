// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/link/autopilot_kind.h"

#include <array>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "kestrel/link/mavlink_enums.h"

namespace kestrel {
namespace {

constexpr std::uint32_t kArduCopterLand = 9;

constexpr std::array<std::pair<std::uint32_t, std::string_view>, 22> kArduCopterModes = {
    {{0, "STABILIZE"}, {1, "ACRO"},          {2, "ALT_HOLD"},   {3, "AUTO"},      {4, "GUIDED"},
     {5, "LOITER"},    {6, "RTL"},           {7, "CIRCLE"},     {9, "LAND"},      {11, "DRIFT"},
     {13, "SPORT"},    {14, "FLIP"},         {15, "AUTOTUNE"},  {16, "POSHOLD"},  {17, "BRAKE"},
     {18, "THROW"},    {20, "GUIDED_NOGPS"}, {21, "SMART_RTL"}, {22, "FLOWHOLD"}, {23, "FOLLOW"},
     {24, "ZIGZAG"},   {27, "AUTO_RTL"}}};

// PX4 has the main mode in the third byte and, of its automatic modes, which one in the fourth.
constexpr std::uint32_t Px4Mode(std::uint32_t main, std::uint32_t sub) {
  return main << 16 | sub << 24;
}
constexpr std::uint32_t kPx4Land = Px4Mode(4, 6);
constexpr std::uint32_t kPx4Precland = Px4Mode(4, 9);

constexpr std::array<std::pair<std::uint32_t, std::string_view>, 15> kPx4Modes = {
    {{Px4Mode(1, 0), "MANUAL"},
     {Px4Mode(2, 0), "ALTCTL"},
     {Px4Mode(3, 0), "POSCTL"},
     {Px4Mode(4, 1), "READY"},
     {Px4Mode(4, 2), "TAKEOFF"},
     {Px4Mode(4, 3), "LOITER"},
     {Px4Mode(4, 4), "MISSION"},
     {Px4Mode(4, 5), "RTL"},
     {kPx4Land, "LAND"},
     {Px4Mode(4, 8), "FOLLOW"},
     {kPx4Precland, "PRECLAND"},
     {Px4Mode(5, 0), "ACRO"},
     {Px4Mode(6, 0), "OFFBOARD"},
     {Px4Mode(7, 0), "STABILIZED"},
     {Px4Mode(8, 0), "RATTITUDE"}}};

template <class Modes>
std::string NameIn(const Modes& modes, std::uint32_t custom_mode) {
  for (const auto& [mode, name] : modes) {
    if (mode == custom_mode) return std::string(name);
  }
  return fmt::format("mode {}", custom_mode);
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

std::string ModeName(AutopilotKind kind, std::uint32_t custom_mode) {
  if (kind == AutopilotKind::kArduPilot) return NameIn(kArduCopterModes, custom_mode);
  if (kind == AutopilotKind::kPx4) return NameIn(kPx4Modes, custom_mode);
  return fmt::format("mode {}", custom_mode);
}

bool IsLandingMode(AutopilotKind kind, std::uint32_t custom_mode) {
  if (kind == AutopilotKind::kArduPilot) return custom_mode == kArduCopterLand;
  return kind == AutopilotKind::kPx4 && (custom_mode == kPx4Land || custom_mode == kPx4Precland);
}

}  // namespace kestrel
