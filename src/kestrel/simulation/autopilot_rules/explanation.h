// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "kestrel/comms/mavlink/target_profile.h"

namespace kestrel {

// A UAV and a pattern at known places.
struct ExplainedScene {
  Eigen::Vector3d uav_in_ned{10, 20, -30};   // m, in the autopilot's local frame
  double heading_deg = 60;                   // heading of the nose, clockwise from north
  Eigen::Vector3d pattern_in_body{2, 1, 5};  // m ahead, right, below
  double size_m = 1;                         // diameter of the pattern
};

// Places at which the autopilots believe the pattern to be, according to their rules,
// after some seconds of targets sent by 'profile'.
struct Understanding {
  // m north, east, down in the local frame; nothing: it ignores the targets.
  std::optional<Eigen::Vector3d> ardupilot_in_ned;
  std::optional<Eigen::Vector3d> px4_in_ned;  // ArduPilot's is horizontal, with the newest depth
  // Their messages to the ground station about it.
  std::string ardupilot_text;
  std::string px4_text;
};
Understanding UnderstandingOf(const ExplainedScene& scene, LinkProfile profile);

// Returns, for each profile, every field of the message that is sent, and the autopilots' belief
// from it.
std::string Explain(const ExplainedScene& scene);

}  // namespace kestrel
