// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/touchdown_timing.h"

#include <algorithm>
#include <cmath>

#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

// A deck on waves moves more than this within kHorizon_s; a car on its springs does not.
constexpr double kHorizon_s = 5;
constexpr double kCalmClimb_mps = 0.25;
constexpr double kCalmSwing = Radians(5);  // range of the tilt
constexpr double kCalmHeight_m = 0.25;     // until the motion is known
// Limits of the deck at touch-down: vertical speed, and tilt above the least tilt. They grow by
// their own size every kPatience_s of waiting.
constexpr double kMaxClimb_mps = 0.2;
constexpr double kMaxTilt = Radians(2);
constexpr double kPatience_s = 10;
constexpr double kDescent_mps = 0.45;     // mean speed from the waiting height to the deck
constexpr double kWaitsBelow = 1.25;      // times the waiting height
constexpr double kLongestForecast_s = 1;  // the deck was not seen for longer: nothing is known

}  // namespace

void TouchdownTiming::Range::Add(double value) {
  least = std::min(least, value);
  most = std::max(most, value);
}

void TouchdownTiming::Observe(Time time, double height_m, const Eigen::Vector3d& normal) {
  const double tilt = std::acos(std::clamp(normal.z(), -1.0, 1.0));
  if (!std::isfinite(height_m) || !std::isfinite(tilt)) return;
  if (!seen_ || ToSeconds(time - *seen_) > DeckMotion::kLongestGap_s) {
    height_ = {height_m, height_m};
    tilt_ = {tilt, tilt};
  }
  height_.Add(height_m);
  tilt_.Add(tilt);
  deck_.Observe(time, height_m, normal);
  seen_ = time;
}

void TouchdownTiming::Reset() {
  waiting_since_.reset();
  goes_down_ = false;
}

std::optional<bool> TouchdownTiming::IsOnWaves() const {
  const auto swing = deck_.SwingWithin(kHorizon_s);
  if (swing) {
    return swing->climb_mps > kCalmClimb_mps || swing->most_tilt - swing->least_tilt > kCalmSwing;
  }
  if (height_.span() > kCalmHeight_m || tilt_.span() > kCalmSwing) return std::nullopt;
  return false;
}

bool TouchdownTiming::Waits(Time now, double height_m) {
  if (goes_down_) return false;
  const std::optional<bool> is_on_waves = IsOnWaves();
  if (!is_on_waves || !*is_on_waves) return !is_on_waves;
  if (height_m > kWaitsBelow * kWaitHeight_m) return true;
  if (!waiting_since_) waiting_since_ = now;
  const double ease = 1 + ToSeconds(now - *waiting_since_) / kPatience_s;
  const auto swing = deck_.SwingWithin(kHorizon_s);
  const auto window = deck_.NextWindow(swing->least_tilt + ease * kMaxTilt, ease * kMaxClimb_mps);
  const double arrival_s = ToSeconds(now - *seen_) + height_m / kDescent_mps;
  goes_down_ = window && window->begin_s <= arrival_s && arrival_s <= window->end_s;
  return !goes_down_;
}

double TouchdownTiming::Climb(Time now, double ahead_s) const {
  if (!IsOnWaves().value_or(false)) return 0;
  const double since_s = ToSeconds(now - *seen_);
  return since_s < kLongestForecast_s ? deck_.Ahead(since_s + ahead_s)->climb_mps : 0;
}

}  // namespace kestrel
