// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/core/base/time.h"

namespace kestrel {

enum class EventLevel { kInfo, kWarning, kError };

// Something that happened in a session, in words for the user.
struct SessionEvent {
  Time time;
  EventLevel level = EventLevel::kInfo;
  std::string text;
};

}  // namespace kestrel
