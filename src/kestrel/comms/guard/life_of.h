// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/comms/guard/guard_messages.h"
#include "kestrel/comms/mavlink/autopilot.h"
#include "kestrel/comms/mavlink/connection.h"

namespace kestrel {

// A sign of life of the program that flies this autopilot over this connection. 'task': what is to
// be done if it is the last one.
inline GuardLife LifeOf(GuardTask task, const Autopilot& autopilot, const Connection& connection) {
  GuardLife life;
  life.task = task;
  life.kind = autopilot.kind();
  life.autopilot_system = autopilot.system();
  life.autopilot_component = autopilot.component();
  life.system = connection.system();
  life.component = connection.component();
  life.signing_timestamp = connection.signing_timestamp();
  return life;
}

}  // namespace kestrel
