// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/touchdown_heading.h"

#include <algorithm>
#include <cmath>

#include "kestrel/core/geometry/angles.h"
#include "kestrel/flight/guidance/guidance_options.h"

namespace kestrel {
namespace {

constexpr double kTurnGain = 2;           // rate of the turn per angle that is left, 1/s
constexpr double kMaxTurnStep_s = 0.2;    // after a gap the turn goes on, without a jump
constexpr double kKnownHeading = 0.0873;  // rad: standard deviation of a heading that is known

bool IsHeadingKnown(const std::optional<TargetEstimate>& target) {
  if (!target || target->yaw_period <= 0) return false;
  const double variance = target->motion.covariance(TurnState::kYaw, TurnState::kYaw);
  return variance <= kKnownHeading * kKnownHeading;
}

}  // namespace

TouchdownHeading::TouchdownHeading(const GuidanceOptions& options)
    : over_pad_(options.HeadingOverPad()),
      tolerance_(Radians(options.heading_tolerance_deg)),
      max_rate_(Radians(options.max_turn_dps)),
      wait_s_(options.heading_wait_s) {}

void TouchdownHeading::Start(double yaw) {
  yaw_ = yaw;
  yaw_rate_ = 0;
  is_known_ = false;
  error_.reset();
  last_.reset();
  waits_since_.reset();
}

void TouchdownHeading::Update(Time now, double nose, const std::optional<TargetEstimate>& target,
                              double link_delay_s) {
  const double step_s = last_ ? std::clamp(ToSeconds(now - *last_), 0.0, kMaxTurnStep_s) : 0.0;
  last_ = now;
  is_known_ = is_wanted() && IsHeadingKnown(target);
  error_.reset();
  yaw_rate_ = 0;
  if (!is_known_) return;
  const double pad_rate = target->motion.turn_rate();
  const double goal = target->motion.yaw() + *over_pad_;
  const double ahead = goal + pad_rate * link_delay_s;
  const double left = std::remainder(ahead - yaw_, target->yaw_period);
  const double turn = std::clamp(kTurnGain * left, -max_rate_, max_rate_);
  yaw_rate_ = pad_rate + turn;
  yaw_ = std::remainder(yaw_ + yaw_rate_ * step_s, kFullTurn);
  error_ = std::remainder(nose - goal, target->yaw_period);
}

bool TouchdownHeading::is_reached() const {
  return !is_wanted() || (error_ && std::abs(*error_) <= tolerance_);
}

bool TouchdownHeading::IsOverdue(Time now, bool waits) {
  if (!waits || is_reached()) {
    waits_since_.reset();
  } else if (!waits_since_) {
    waits_since_ = now;
  }
  return waits_since_ && ToSeconds(now - *waits_since_) >= wait_s_;
}

}  // namespace kestrel
