// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "kestrel/comms/mavlink/autopilot.h"
#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/core/base/time.h"

namespace kestrel {

// Notices that an autopilot loses its position: when its estimator reports none, and already when
// its first GNSS receiver loses the fix that it had, from when on it guesses for seconds. Two
// reports in a row count: of GNSS 0.2 s apart, of the estimator half a second.
class PositionLoss {
 public:
  // Call it steadily. True while the position is lost.
  bool IsLost(const Autopilot& autopilot) {
    constexpr int kReports = 2, kFix = 3;
    const auto& gnss = autopilot.status().gnss();
    if (gnss && gnss->received != gnss_time_) {
      gnss_time_ = gnss->received;
      const bool is_fixed = gnss->fix >= kFix;
      had_fix_ = had_fix_ || is_fixed;
      without_fix_ = had_fix_ && !is_fixed ? without_fix_ + 1 : 0;
    }
    const auto& estimator = autopilot.status().estimator();
    if (estimator && estimator->received != estimator_time_) {
      estimator_time_ = estimator->received;
      without_position_ = HasPosition(estimator->flags) ? 0 : without_position_ + 1;
    }
    return without_fix_ >= kReports || without_position_ >= kReports;
  }

 private:
  // A glitch of GNSS, which the estimator rides through, is no loss.
  static bool HasPosition(std::uint16_t flags) {
    constexpr std::uint16_t kPosition =
        mavlink::kEstimatorPositionRelative | mavlink::kEstimatorPositionAbsolute;
    return (flags & kPosition) != 0 && (flags & mavlink::kEstimatorVelocityHorizontal) != 0 &&
           (flags & mavlink::kEstimatorConstantPosition) == 0;
  }

  Time gnss_time_{}, estimator_time_{};  // of the newest reports
  bool had_fix_ = false;
  int without_fix_ = 0, without_position_ = 0;  // reports in a row
};

}  // namespace kestrel
