// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <Eigen/Core>

#include "kestrel/comms/mavlink/autopilot.h"
#include "kestrel/comms/mavlink/connection.h"
#include "kestrel/comms/mavlink/global_position.h"
#include "kestrel/comms/mavlink/messages.h"
#include "kestrel/core/base/limits.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/geometry/rigid_transform.h"

namespace kestrel {

// Form in which a landing target is reported to an autopilot.
enum class LinkProfile {
  kArduPilot,  // LANDING_TARGET relative to the body: the only form that ArduPilot accepts
  kPx4,        // LANDING_TARGET as a place in the local frame: the only form for PX4 without VTE_EN
  kPx4Vte,     // TARGET_RELATIVE with its uncertainty, for PX4's vision target estimator (VTE_EN)
};
const char* ToString(LinkProfile profile);  // "ardupilot", "px4", "px4-vte"

// Parses a name as above. Throws InputError for any other.
LinkProfile ParseLinkProfile(const std::string& name);

// Returns the profile for an autopilot of this kind: kPx4 for PX4, kArduPilot for all others.
LinkProfile ProfileFor(AutopilotKind kind);

// Target and UAV at an instant, usually a predicted one: the time at which the autopilot uses the
// report.
struct TargetState {
  Time time;                       // local clock
  RigidTransform world_from_body;  // UAV (FLU) in the world (ENU)
  Eigen::Vector3d position_in_world{0, 0, 0};
  Eigen::Vector3d normal_in_world{0, 0, 1};  // normal of the board, upwards
  Eigen::Vector3d velocity_in_world{0, 0, 0};
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // uncertainty from the UAV, m^2
  std::optional<double> yaw = std::nullopt;  // heading in the world, rad from east to north
  double yaw_sigma = 0;                      // rad
  double size_m = 0;                         // diameter of the pattern; 0: not known

  Eigen::Vector3d position_in_body() const { return world_from_body.Inverse() * position_in_world; }
};

// Make the messages. 'stamp_us' is the report's time on the autopilot's clock (see
// TimeSync::ToRemote), in us; 0 where that is not known.
mavlink::LandingTarget LandingTargetForArduPilot(const TargetState& report, std::uint64_t stamp_us);
mavlink::LandingTarget LandingTargetForPx4(const TargetState& report, std::uint64_t stamp_us);
mavlink::TargetRelative TargetRelativeForPx4(const TargetState& report, std::uint64_t stamp_us);

// Returns the distance that a rangefinder under the UAV would measure to the target's plane;
// nothing when the plane is not below, or beyond 'max_m'. 'boot_ms': the report's time on the
// autopilot's clock.
std::optional<mavlink::DistanceSensor> DistanceSensorOf(const TargetState& report, double max_m,
                                                        std::uint32_t boot_ms);

// Returns the target's position on the Earth, for follow modes.
mavlink::FollowTarget FollowTargetOf(const TargetState& report, AutopilotKind kind,
                                     const GlobalPosition& origin, std::uint64_t boot_ms);

// Messages that are sent beside that of the profile.
struct TargetMessageOptions {
  bool sends_distance = false;
  double max_distance_m = 40;
  bool sends_follow_target = false;

  static void Visit(auto& self, auto&& visit) {
    visit("sends_distance", self.sends_distance,
          "DISTANCE_SENSOR is sent, too: the height above the target, as a rangefinder's");
    visit("max_distance_m", self.max_distance_m, Range{1, 655},
          "largest height that DISTANCE_SENSOR reports");
    visit("sends_follow_target", self.sends_follow_target,
          "FOLLOW_TARGET is sent, too, once the autopilot has reported its origin");
  }
};

// Sends the profile's message for the report, and those of the options. False when the target's
// message was not sent: the line did not accept it, or kPx4Vte does not know the autopilot's clock
// yet. PX4's estimator refuses times in the future: with kPx4Vte a report should not be later than
// 'now'; a later one is stamped with 'now'.
bool SendTarget(LinkProfile profile, const TargetMessageOptions& options, const TargetState& report,
                const Autopilot& autopilot, Time now, Connection* connection);

}  // namespace kestrel
