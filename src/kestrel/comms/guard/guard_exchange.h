// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "kestrel/comms/guard/flight_guard.h"
#include "kestrel/comms/guard/guard_messages.h"
#include "kestrel/comms/mavlink/command_requests.h"
#include "kestrel/comms/mavlink/packet.h"
#include "kestrel/comms/mavlink/set_point_message.h"
#include "kestrel/core/base/time.h"

// Messages between the guard and the autopilot.
namespace kestrel {

// Takes what the guard needs from a packet of the autopilot. 'life': the newest sign of life.
void TakePacket(const mavlink::Packet& packet, const GuardLife& life, Time now, FlightGuard* guard);

// Sends the messages of an action, except its text, with send(message).
template <class Send>
void SendAction(const GuardAction& action, const GuardLife& life, const Send& send) {
  const std::uint8_t system = life.autopilot_system, component = life.autopilot_component;
  if (action.stop) send(SetPointMessage(*action.stop, life.kind, system, component, /*boot_ms=*/0));
  constexpr float kNoClimb = 0.5F;
  if (action.level) send(LevelMessage(*action.level, kNoClimb, system, component, /*boot_ms=*/0));
  if (action.mode) {
    send(ModeCommand(life.kind, CustomModeOf(life.kind, *action.mode), system, component));
  }
}

}  // namespace kestrel
