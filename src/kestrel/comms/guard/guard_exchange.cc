// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/guard/guard_exchange.h"

#include <cmath>

#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/comms/mavlink/messages.h"
#include "kestrel/comms/mavlink/ned.h"
#include "kestrel/comms/mavlink/pilot_sticks.h"

namespace kestrel {
namespace {

// GUIDED_NOGPS is a mode of set-points for a program that flies without a position.
bool IsGuided(const GuardLife& life, std::uint32_t custom_mode) {
  const bool may_lean = life.task == GuardTask::kLower || life.task == GuardTask::kLand;
  return IsGuidedMode(life.kind, custom_mode) ||
         (may_lean && IsGuidedByLeanMode(life.kind, custom_mode));
}

}  // namespace

void TakePacket(const mavlink::Packet& packet, const GuardLife& life, Time now,
                FlightGuard* guard) {
  if (const auto heartbeat = packet.As<mavlink::Heartbeat>()) {
    guard->TakeMode(IsGuided(life, heartbeat->custom_mode), now);
    guard->TakeArmed((heartbeat->base_mode & mavlink::kModeFlagArmed) != 0);
  } else if (const auto mode = packet.As<mavlink::CurrentMode>()) {
    guard->TakeMode(IsGuided(life, mode->custom_mode), now);
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
