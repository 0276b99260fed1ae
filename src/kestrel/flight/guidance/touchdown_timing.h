// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "kestrel/core/base/time.h"
#include "kestrel/flight/guidance/deck_motion.h"

namespace kestrel {

// The moment of touch-down on a deck that moves on waves: the UAV waits low above it, moving up and
// down with it, until it will be level and hardly rise when the feet arrive. The longer it waits
// the less it demands. A deck that drives on a road, sloping or not, is not waited for.
class TouchdownTiming {
 public:
  // Takes a sighting of the deck: its height (m, world) and its normal in the world.
  void Observe(Time time, double height_m, const Eigen::Vector3d& normal);
  // Forgets the decision to go down: the UAV has gone around.
  void Reset();

  // Decides for a UAV that descends, with the feet 'height_m' above the deck. Call it in order of
  // time. True while the UAV should not go below kWaitHeight_m.
  bool Waits(Time now, double height_m);

  // Vertical velocity of the deck 'ahead_s' from 'now', m/s; 0 for a deck without waves.
  double Climb(Time now, double ahead_s) const;

  static constexpr double kWaitHeight_m = 0.8;

 private:
  // Heights and tilts since the first sighting.
  struct Range {
    double least = 0, most = 0;
    void Add(double value);
    double span() const { return most - least; }
  };
  // On waves, as far as is known; nothing while the deck moves and it is not known how.
  std::optional<bool> IsOnWaves() const;

  DeckMotion deck_;
  Range height_, tilt_;
  std::optional<Time> seen_;
  std::optional<Time> waiting_since_;
  bool goes_down_ = false;
};

}  // namespace kestrel
