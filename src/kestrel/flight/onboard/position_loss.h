// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "kestrel/comms/mavlink/autopilot.h"
#include "kestrel/core/base/time.h"

namespace kestrel {

// Notices that an autopilot loses its position: by its own report, and already when its GNSS
// receiver loses the fix, from when on it guesses for seconds.
class PositionLoss {
 public:
  // Call it steadily. True while the position is lost, from half a second on.
  bool IsLost(const Autopilot& autopilot, Time now) {
    constexpr int kFix = 3;
    constexpr double kSure_s = 0.5;
    const auto& gnss = autopilot.status().gnss();
    const bool is_fixed = gnss && gnss->fix >= kFix;
    had_fix_ = had_fix_ || is_fixed;
    const bool is_bad = !autopilot.is_position_good(now).value_or(true) || (had_fix_ && !is_fixed);
    if (!is_bad) since_.reset();
    if (is_bad && !since_) since_ = now;
    return since_ && ToSeconds(now - *since_) >= kSure_s;
  }

 private:
  bool had_fix_ = false;
  std::optional<Time> since_;
};

}  // namespace kestrel
