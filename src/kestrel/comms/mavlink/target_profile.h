// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "kestrel/comms/mavlink/autopilot.h"
#include "kestrel/comms/mavlink/connection.h"
#include "kestrel/comms/mavlink/global_position.h"
#include "kestrel/comms/mavlink/messages.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/geometry/rigid_transform.h"

namespace kestrel {

// How an autopilot is told of a landing target.
enum class LinkProfile {
  kArduPilot,  // LANDING_TARGET relative to the body: all that ArduPilot takes
  kPx4,        // LANDING_TARGET as a place in the local frame: all that PX4 takes without the next
  kPx4Vte,     // TARGET_RELATIVE with its uncertainty, for PX4's vision target estimator (VTE_EN)
};
const char* ToString(LinkProfile profile);  // "ardupilot", "px4", "px4-vte"

// Of a name as above. Throws InputError when it is none.
LinkProfile ParseLinkProfile(const std::string& name);

// What suits an autopilot of this kind: kPx4 for PX4, kArduPilot for all others.
LinkProfile ProfileFor(AutopilotKind kind);

// Where the target and the UAV are at an instant, mostly a predicted one: when the autopilot will
// use it.
struct TargetReport {
  Time time;                       // local clock
  RigidTransform world_from_body;  // UAV (FLU) in the world (ENU)
  Eigen::Vector3d position_in_world{0, 0, 0};
  Eigen::Vector3d velocity_in_world{0, 0, 0};
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // of the position relative to the UAV, m^2
  std::optional<double> yaw = std::nullopt;  // of the target in the world, rad from east to north
  double yaw_sigma = 0;                      // rad
  double size_m = 0;                         // across the pattern; 0: not known

  Eigen::Vector3d position_in_body() const { return world_from_body.Inverse() * position_in_world; }
};

// The messages. 'stamp_us' is the report's time on the autopilot's clock (see TimeSync::ToRemote),
// in us; 0 where that is not known.
mavlink::LandingTarget LandingTargetForArduPilot(const TargetReport& report,
                                                 std::uint64_t stamp_us);
mavlink::LandingTarget LandingTargetForPx4(const TargetReport& report, std::uint64_t stamp_us);
mavlink::TargetRelative TargetRelativeForPx4(const TargetReport& report, std::uint64_t stamp_us);

// What a rangefinder under the UAV would measure to the plane of the target; nothing when that is
// not below, or beyond 'max_m'. 'boot_ms': the report's time on the autopilot's clock.
std::optional<mavlink::DistanceSensor> DistanceSensorOf(const TargetReport& report, double max_m,
                                                        std::uint32_t boot_ms);

// Where the target is on the Earth, for follow modes.
mavlink::FollowTarget FollowTargetOf(const TargetReport& report, AutopilotKind kind,
                                     const GlobalPosition& origin, std::uint64_t boot_ms);

// Which messages are sent beside that of the profile.
struct TargetMessageOptions {
  bool sends_distance = false;
  double max_distance_m = 40;
  bool sends_follow_target = false;

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("sends_distance", self.sends_distance, "",
            "also DISTANCE_SENSOR: the height above the target, as a rangefinder's");
    visitor("max_distance_m", self.max_distance_m, "m", "largest distance of that");
    visitor("sends_follow_target", self.sends_follow_target, "",
            "also FOLLOW_TARGET, once the autopilot has told its origin");
  }
  std::vector<std::string> Validate() const;
};

// Sends what the profile says of the report, and what the options say. False when the target's
// message was not sent: the line did not take it, or kPx4Vte does not know the autopilot's clock
// yet. PX4's estimator refuses the future: a report of kPx4Vte is to be of 'now' at the latest, a
// later one is stamped with 'now'.
bool SendTarget(LinkProfile profile, const TargetMessageOptions& options,
                const TargetReport& report, const Autopilot& autopilot, Time now,
                Connection* connection);

}  // namespace kestrel
