// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>

#include "kestrel/core/base/time.h"

namespace kestrel {

// Horizontal motion of a deck that carries the UAV, measured by the UAV's own velocity.
class DeckRide {
 public:
  // Takes the UAV's velocity (m/s, world) at 'now' while it stands on the deck.
  void Observe(Time now, const Eigen::Vector2d& velocity);
  // The UAV has left the deck.
  void Reset();

  // Returns the velocity of the deck (m/s) 'ahead_s' after the newest observation, by its
  // acceleration.
  Eigen::Vector2d Velocity(double ahead_s) const;
  const Eigen::Vector2d& acceleration() const { return acceleration_; }  // smoothed, m/s^2

 private:
  std::optional<Time> time_;  // time of the newest velocity
  Eigen::Vector2d velocity_{0, 0};
  Eigen::Vector2d acceleration_{0, 0};
};

}  // namespace kestrel
