// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/guard/guard_exchange.h"

#include <cmath>
#include <cstdlib>

#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/comms/mavlink/messages.h"
#include "kestrel/comms/mavlink/ned.h"

namespace kestrel {
namespace {

// PX4 reports a transmitter that is lost as healthy, but not as present; ArduPilot the other way.
bool IsReceiving(const mavlink::SysStatus& status) {
  return (status.onboard_control_sensors_present & status.onboard_control_sensors_health &
          mavlink::kSensorReceiver) != 0;
}

bool IsThrottleCentred(const mavlink::RcChannels& channels) {
  constexpr int kMiddle_us = 1500, kMargin_us = 100;
  return std::abs(channels.chan3_raw - kMiddle_us) < kMargin_us;
}

}  // namespace

void TakePacket(const mavlink::Packet& packet, const GuardLife& life, Time now,
                FlightGuard* guard) {
  if (const auto heartbeat = packet.As<mavlink::Heartbeat>()) {
    guard->TakeMode(IsGuidedMode(life.kind, heartbeat->custom_mode), now);
    guard->TakeArmed((heartbeat->base_mode & mavlink::kModeFlagArmed) != 0);
  } else if (const auto mode = packet.As<mavlink::CurrentMode>()) {
    guard->TakeMode(IsGuidedMode(life.kind, mode->custom_mode), now);
  } else if (const auto position = packet.As<mavlink::LocalPositionNed>()) {
    guard->TakeVelocity(EnuFromNed({position->vx, position->vy, position->vz}), now);
  } else if (const auto attitude = packet.As<mavlink::AttitudeQuaternion>()) {
    guard->TakeHeading(2 * std::atan2(attitude->q4, attitude->q1));
  } else if (const auto status = packet.As<mavlink::SysStatus>()) {
    guard->TakeReceiver(IsReceiving(*status));
  } else if (const auto channels = packet.As<mavlink::RcChannels>()) {
    guard->TakeThrottle(IsThrottleCentred(*channels), now);
  } else if (const auto ack = packet.As<mavlink::CommandAck>()) {
    const bool is_open =
        ack->result == mavlink::kResultAccepted || ack->result == mavlink::kResultInProgress;
    if (IsModeCommand(ack->command) && !is_open) guard->TakeRefusal();
  }
}

}  // namespace kestrel
