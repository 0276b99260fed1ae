// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/deck_ride.h"

#include <cmath>

namespace kestrel {

void DeckRide::Observe(Time now, const Eigen::Vector2d& velocity) {
  constexpr double kSmoothing_s = 0.3;
  const double seconds = time_ ? ToSeconds(now - *time_) : 0;
  if (seconds > 0) {
    const double part = 1 - std::exp(-seconds / kSmoothing_s);
    acceleration_ += part * ((velocity - velocity_) / seconds - acceleration_);
  }
  time_ = now;
  velocity_ = velocity;
}

void DeckRide::Reset() { *this = {}; }

Eigen::Vector2d DeckRide::Velocity(double ahead_s) const {
  return velocity_ + ahead_s * acceleration_;
}

}  // namespace kestrel
