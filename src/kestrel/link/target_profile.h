// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include <Eigen/Core>

#include "kestrel/link/autopilot_kind.h"
#include "kestrel/link/global_position.h"
#include "kestrel/link/messages.h"
#include "kestrel/link/target_report.h"

namespace kestrel {

// How an autopilot is told of the landing target; what each does with it is in docs/fly.md.
enum class LinkProfile {
  kArduPilot,  // LANDING_TARGET, relative, in the body's axes
  kPx4,        // LANDING_TARGET, a place in the local frame
  kPx4Vte,     // TARGET_RELATIVE with its uncertainty
};
const char* ToString(LinkProfile profile);  // "ardupilot", "px4", "px4-vte"

// Nothing for a name that is none.
std::optional<LinkProfile> ParseLinkProfile(std::string_view name);
// The profile that every autopilot of this kind takes; nothing where none is known to.
std::optional<LinkProfile> ProfileOf(AutopilotKind kind);

// Each from the target at 'report.time', which is 'time_us' on the autopilot's clock.

// 'camera_in_frd': where the autopilot takes the camera to be (PLND_CAM_POS, m): it
// adds that to what it is told. 'size_m': of the pattern.
mavlink::LandingTarget ArduPilotTarget(const TargetReport& report, std::uint64_t time_us,
                                       const Eigen::Vector3d& camera_in_frd, double size_m);
mavlink::LandingTarget Px4Target(const TargetReport& report, std::uint64_t time_us);
mavlink::TargetRelative Px4VteTarget(const TargetReport& report, std::uint64_t time_us);

// The height of the body above the target as a range finder that looks down would measure it;
// 'minimum_m' and 'maximum_m': of what can be measured.
mavlink::DistanceSensor TargetDistance(const TargetReport& report, std::uint32_t time_boot_ms,
                                       double minimum_m, double maximum_m);

// 'origin': of the autopilot's local frame.
mavlink::FollowTarget TargetToFollow(const TargetReport& report, AutopilotKind kind,
                                     const GlobalPosition& origin, std::uint32_t time_boot_ms);

}  // namespace kestrel
