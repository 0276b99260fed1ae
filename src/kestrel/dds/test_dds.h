// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdlib>
#include <unistd.h>

namespace kestrel {

// A domain of this run's own, on this computer alone, for this process and those that it starts.
inline int TestDomain() {
  setenv("CYCLONEDDS_URI",
         "<General><AllowMulticast>false</AllowMulticast><Interfaces><NetworkInterface "
         "name=\"lo\"/></Interfaces></General><Discovery><ParticipantIndex>auto</ParticipantIndex>"
         "<Peers><Peer address=\"127.0.0.1\"/></Peers></Discovery>",
         1);
  return getpid() % 100;
}

}  // namespace kestrel
