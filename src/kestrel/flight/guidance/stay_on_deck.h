// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/set_point.h"
#include "kestrel/flight/guidance/carried_proof.h"
#include "kestrel/flight/guidance/deck_ride.h"
#include "kestrel/flight/guidance/guidance_options.h"
#include "kestrel/flight/guidance/guidance_request.h"

namespace kestrel {

// Guidance from contact to disarming: the UAV goes on down and is carried, until the autopilot has
// found the ground, or there is proof that it stands on a deck.
class StayOnDeck {
 public:
  explicit StayOnDeck(const GuidanceOptions& options) : options_(options) {}

  // Contact has begun.
  void Reset();

  // Returns the set-point, by the UAV's attitude (body to world) and velocity (m/s, world) at
  // 'now'. 'delay_s': from a set-point to its effect. The autopilot then finds that it has landed:
  // it does not lean against the motion of the deck. One that needs a velocity gets the deck's.
  SetPoint Rest(Time now, const Eigen::Quaterniond& world_from_body,
                const Eigen::Vector3d& velocity, double delay_s);

  // Returns the request after Rest: LAND, disarming, or none. 'is_landed': the autopilot reports
  // that it is on the ground. 'touches_since': the feet rest against the deck, by their motion.
  GuidanceRequest Request(Time now, bool is_landed, const std::optional<Time>& touches_since) const;

 private:
  GuidanceOptions options_;
  DeckRide ride_;
  CarriedProof carried_;
  std::optional<Time> stands_since_;  // the deck
};

}  // namespace kestrel
