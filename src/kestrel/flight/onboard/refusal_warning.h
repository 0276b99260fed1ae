// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "kestrel/core/base/time.h"

namespace kestrel {

// When to warn a pilot, once a flight, that guidance would be refused, before the pilot tries: PX4
// refuses OFFBOARD without set-points, and reports no reason.
class RefusalWarning {
 public:
  // True when the warning is due. 'may_begin': there is no reason to refuse.
  bool IsDue(bool is_flying, bool may_begin, Time now) {
    constexpr double kPatience_s = 4;  // reasons of the first seconds pass
    if (!is_flying) was_given_ = false;
    if (!is_flying || may_begin) {
      since_.reset();
      return false;
    }
    if (!since_) since_ = now;
    if (was_given_ || ToSeconds(now - *since_) < kPatience_s) return false;
    was_given_ = true;
    return true;
  }

 private:
  std::optional<Time> since_;  // refused in flight
  bool was_given_ = false;     // in this flight
};

}  // namespace kestrel
