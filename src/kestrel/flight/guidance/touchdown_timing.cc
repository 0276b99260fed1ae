// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/touchdown_timing.h"

#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

// A deck on waves moves more than this within kHorizon_s; a car on its springs does not.
constexpr double kHorizon_s = 5;
constexpr double kCalmClimb_mps = 0.25;
constexpr double kCalmSwing = Radians(5);  // of the tilt
// What is asked of the deck at touch-down: vertical speed, and tilt above the least tilt. The
// limits double every kPatience_s of waiting.
constexpr double kMaxClimb_mps = 0.2;
constexpr double kMaxTilt = Radians(2);
constexpr double kPatience_s = 10;
constexpr double kDescent_s = 1.4;        // from the waiting height to the deck
constexpr double kWaitsBelow = 1.25;      // times the waiting height
constexpr double kLongestForecast_s = 1;  // the deck was not seen for longer: nothing is known

}  // namespace

void TouchdownTiming::Observe(Time time, double height_m, const Eigen::Vector3d& normal) {
  deck_.Observe(time, height_m, normal);
  seen_ = time;
}

void TouchdownTiming::Reset() {
  waiting_since_.reset();
  goes_down_ = false;
}

bool TouchdownTiming::IsOnWaves() const {
  const auto swing = deck_.SwingWithin(kHorizon_s);
  if (!swing) return false;
  return swing->climb_mps > kCalmClimb_mps || swing->most_tilt - swing->least_tilt > kCalmSwing;
}

bool TouchdownTiming::Waits(Time now, double height_m) {
  if (goes_down_ || !IsOnWaves()) return false;
  if (height_m > kWaitsBelow * kWaitHeight_m) return true;
  if (!waiting_since_) waiting_since_ = now;
  const double ease = 1 + ToSeconds(now - *waiting_since_) / kPatience_s;
  const auto swing = deck_.SwingWithin(kHorizon_s);
  const auto window = deck_.NextWindow(swing->least_tilt + ease * kMaxTilt, ease * kMaxClimb_mps);
  const double arrival_s = ToSeconds(now - seen_) + kDescent_s;
  goes_down_ = window && window->begin_s <= arrival_s && arrival_s <= window->end_s;
  return !goes_down_;
}

double TouchdownTiming::Climb(Time now, double ahead_s) const {
  const double since_s = ToSeconds(now - seen_);
  if (since_s > kLongestForecast_s || !IsOnWaves()) return 0;
  return deck_.Ahead(since_s + ahead_s)->climb_mps;
}

}  // namespace kestrel
