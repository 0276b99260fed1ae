// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>

#include "kestrel/core/base/time.h"

namespace kestrel {

// How a deck moves that carries the UAV along: as the UAV does, by its own velocity. Horizontal.
class DeckRide {
 public:
  // The UAV's velocity at 'now', while it stands on the deck, m/s.
  void Observe(Time now, const Eigen::Vector2d& velocity);
  // It stands on it no longer.
  void Reset();

  // Of the deck, in a curve that goes on, 'ahead_s' after the newest velocity.
  Eigen::Vector2d Velocity(double ahead_s) const;
  const Eigen::Vector2d& acceleration() const { return acceleration_; }  // smoothed, m/s^2

 private:
  std::optional<Time> time_;  // of the newest velocity
  Eigen::Vector2d velocity_{0, 0};
  Eigen::Vector2d acceleration_{0, 0};
};

}  // namespace kestrel
