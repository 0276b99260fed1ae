// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "kestrel/comms/mavlink/autopilot_kind.h"
#include "kestrel/comms/mavlink/messages.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/geometry/rigid_transform.h"

namespace kestrel {

// A pose of the UAV that something other than the autopilot's own sensors has measured: the
// autopilot's external navigation.
struct ExternalPose {
  Time time;                       // when it was measured, on the local clock
  RigidTransform frame_from_body;  // body FLU; the frame is level, its z axis points up
  Eigen::Matrix3d covariance;      // how uncertain the position is, m^2, in the frame
  double tilt_sigma = 0;           // roll and pitch, rad
  double heading_sigma = 0;        // rad
  std::uint8_t resets = 0;         // number of jumps of the frame so far, modulo 256
};

// Returns the message with its stamp on the autopilot's clock. Both autopilots take a local frame
// of any heading (FRD) with the body's; no velocity is sent. 'kind': ArduPilot reads one standard
// deviation out of three variances in a way of its own, see the source.
mavlink::Odometry OdometryOf(const ExternalPose& pose, AutopilotKind kind, std::uint64_t stamp_us);

}  // namespace kestrel
