// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <thread>

#include "kestrel/core/base/time.h"

namespace kestrel {

// Returns true as soon as the condition holds; false when it still does not after 'limit'. For what
// happens in another thread or program that has no event to wait for.
template <class Condition>
bool Eventually(const Condition& condition, Duration limit = std::chrono::seconds(20)) {
  constexpr Duration kPeriod = std::chrono::milliseconds(5);
  for (const Time end = Now() + limit; Now() < end;) {
    if (condition()) return true;
    std::this_thread::sleep_for(kPeriod);
  }
  return condition();
}

}  // namespace kestrel
