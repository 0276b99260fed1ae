// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/comms/mavlink/connection.h"

namespace kestrel {

// Returns why no autopilot is heard on the line, in a few words with the line's name and what to
// look at: "nothing received on /dev/ttyAMA0", "bytes on /dev/ttyAMA0, but no MAVLink: ...".
std::string WhySilent(const Connection& connection);

}  // namespace kestrel
