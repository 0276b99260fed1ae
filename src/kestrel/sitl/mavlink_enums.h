// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

// Numbers of MAVLink's enums that the simulated autopilots speak in.
namespace kestrel::mavlink {

// MAV_FRAME
inline constexpr std::uint8_t kFrameLocalNed = 1;
inline constexpr std::uint8_t kFrameBodyFrd = 12;
inline constexpr std::uint8_t kFrameLocalFrd = 20;

// TARGET_OBS_FRAME of TARGET_RELATIVE
inline constexpr std::uint8_t kTargetFrameLocalNed = 0;
inline constexpr std::uint8_t kTargetFrameBodyFrd = 1;
inline constexpr std::uint8_t kTargetFrameLocalOffsetNed = 2;
inline constexpr std::uint8_t kTargetFrameOther = 3;

}  // namespace kestrel::mavlink
