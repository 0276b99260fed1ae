// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "kestrel/comms/mavlink/autopilot.h"
#include "kestrel/comms/mavlink/connection.h"
#include "kestrel/comms/mavlink/messages.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/set_point.h"

namespace kestrel {

// A set-point as ArduPilot's GUIDED and PX4's OFFBOARD take it alike: velocity, acceleration and
// heading in the frame LOCAL_NED, nothing else. Without a yaw the nose stays: ArduPilot, which
// would turn it along the velocity, is told to turn with a rate of zero. 'boot_ms': now, on the
// autopilot's clock.
mavlink::SetPositionTargetLocalNed SetPointMessage(const SetPoint& set_point, AutopilotKind kind,
                                                   std::uint8_t system, std::uint8_t component,
                                                   std::uint32_t boot_ms);

// Sends it. False when it was not sent: it is not finite, or the line did not take it.
bool SendSetPoint(const SetPoint& set_point, const Autopilot& autopilot, Time now,
                  Connection* connection);

}  // namespace kestrel
