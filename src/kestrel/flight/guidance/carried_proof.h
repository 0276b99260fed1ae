// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>

#include "kestrel/core/base/time.h"

namespace kestrel {

// Proof that a deck carries the UAV: it moves as no flight would. The land detectors of autopilots
// take no deck that turns fast or heaves for ground, and the rotors would go on.
//
// Two things are proof while a descent is commanded: the UAV accelerates and does not lean for it,
// or it rises. A steady wind makes the opposite, a lean without an acceleration. A gust may look
// like a proof, but not for seconds at the height of the deck.
class CarriedProof {
 public:
  struct Motion {
    Eigen::Vector3d thrust_axis;   // up axis of the body in the world
    Eigen::Vector2d acceleration;  // horizontal, smoothed, m/s^2, world
    double climb_mps;
  };
  // Takes the UAV's motion at 'now', in contact, while a descent is commanded.
  void Observe(Time now, const Motion& motion);
  // The UAV has left the deck.
  void Reset();

  double seconds() const { return seconds_; }  // for so long there was proof, in sum

 private:
  std::optional<Time> last_;
  double seconds_ = 0;
};

}  // namespace kestrel
