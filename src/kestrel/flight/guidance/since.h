// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "kestrel/core/base/time.h"

namespace kestrel {

// Returns whether something has been so since 'seconds' ago or longer; false while it is not.
inline bool IsLongerThan(double seconds, const std::optional<Time>& since, Time now) {
  return since && ToSeconds(now - *since) >= seconds;
}

// Keeps in 'since' the time at which 'is' became true; nothing while it is false.
inline void Remember(bool is, Time now, std::optional<Time>* since) {
  if (!is) {
    since->reset();
  } else if (!*since) {
    *since = now;
  }
}

}  // namespace kestrel
