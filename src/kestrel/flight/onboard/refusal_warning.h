// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "kestrel/core/base/time.h"

namespace kestrel {

// The warning for a mode that is given to an autopilot of which nobody knows whether it flies.
constexpr char kNotKnownToFly[] =
    "guidance waits: the autopilot does not report whether it is in the air";

// When to warn a pilot, once a flight, that guidance would be refused, before the pilot tries: PX4
// refuses OFFBOARD without set-points, and reports no reason. Or, once a mode, that it waits.
class RefusalWarning {
 public:
  // 'patience_s': until it is due. Reasons of the first seconds of a flight pass.
  explicit RefusalWarning(double patience_s = 4) : patience_s_(patience_s) {}

  // True when the warning is due. 'is_on': the flight, or the mode. 'may_begin': there is no reason
  // to refuse.
  bool IsDue(bool is_on, bool may_begin, Time now) {
    if (!is_on) was_given_ = false;
    if (!is_on || may_begin) {
      since_.reset();
      return false;
    }
    if (!since_) since_ = now;
    if (was_given_ || ToSeconds(now - *since_) < patience_s_) return false;
    was_given_ = true;
    return true;
  }

 private:
  double patience_s_;
  std::optional<Time> since_;  // refused
  bool was_given_ = false;     // in this flight, or mode
};

}  // namespace kestrel
