// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdlib>

#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/comms/mavlink/messages.h"

// A pilot is there when the autopilot receives a transmitter whose throttle is in its middle. With
// the throttle down a mode that follows it would sink as fast as it may.
namespace kestrel {

// PX4 reports a transmitter that is lost as healthy, but not as present; ArduPilot the other way.
inline bool IsReceiving(const mavlink::SysStatus& status) {
  return (status.onboard_control_sensors_present & status.onboard_control_sensors_health &
          mavlink::kSensorReceiver) != 0;
}

inline bool IsThrottleCentred(const mavlink::RcChannels& channels) {
  constexpr int kMiddle_us = 1500, kMargin_us = 100;
  return std::abs(channels.chan3_raw - kMiddle_us) < kMargin_us;
}

}  // namespace kestrel
