// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "kestrel/core/base/time.h"

namespace kestrel {

// Contact: the feet are near the deck and at rest against it, as when the legs stand on it.
struct ContactOptions {
  double height_m = 0.25;  // largest height of the feet above the deck, by the track
  double reach_m = 0.6;    // largest horizontal distance of the feet from the deck's middle
  // Largest closing speed: below the sink rate of an autopilot near the ground, and more than an
  // estimate is wrong after the shock of touch-down (0.12 m/s was seen).
  double speed_mps = 0.25;
  double time_s = 0.5;  // shortest duration of these conditions: longer than the bottom of a bounce
};

// Decides whether the UAV stands on the deck. After contact the camera sees nothing any more:
// contact therefore lasts until the feet have risen by twice height_m, faster than a deck carries
// them or an estimate of the height drifts.
class ContactDetector {
 public:
  explicit ContactDetector(const ContactOptions& options) : options_(options) {}

  struct Deck {
    Eigen::Vector3d position;
    Eigen::Vector3d velocity;
  };
  // Takes position (m) and velocity (m/s) of the feet and of the deck in the world; no deck while
  // it is not known. Returns has_contact().
  bool Update(Time now, const Eigen::Vector3d& feet, const Eigen::Vector3d& velocity,
              const std::optional<Deck>& deck);

  bool has_contact() const { return contact_z_m_.has_value(); }
  void Reset();

 private:
  void FollowDeck(Time now, double feet_z_m);
  bool RestsOn(const Deck& deck, const Eigen::Vector3d& feet,
               const Eigen::Vector3d& velocity) const;

  ContactOptions options_;
  std::optional<Time> resting_since_;
  std::optional<double> contact_z_m_;  // height of the deck below the feet
  Time last_;                          // time of the last update
};

}  // namespace kestrel
