// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/contact_detector.h"

#include <algorithm>
#include <cmath>

namespace kestrel {

bool ContactDetector::Update(Time now, const Eigen::Vector3d& feet, const Eigen::Vector3d& velocity,
                             const std::optional<Deck>& deck) {
  if (contact_z_m_) FollowDeck(now, feet.z());
  last_ = now;
  if (contact_z_m_ && feet.z() > *contact_z_m_ + 2 * options_.height_m) Reset();
  if (contact_z_m_) return true;
  if (!deck || !RestsOn(*deck, feet, velocity)) {
    resting_since_.reset();
    return false;
  }
  if (!resting_since_) resting_since_ = now;
  if (now - *resting_since_ < DurationFromSeconds(options_.time_s)) return false;
  contact_z_m_ = feet.z();
  return true;
}

// The deck heaves or drives uphill, and the estimated height drifts.
void ContactDetector::FollowDeck(Time now, double feet_z_m) {
  constexpr double kCarried_mps = 1;
  constexpr double kSeen_s = 0.2;  // what happened in a longer gap was not seen
  const double most_m = kCarried_mps * std::min(ToSeconds(now - last_), kSeen_s);
  *contact_z_m_ += std::clamp(feet_z_m - *contact_z_m_, -most_m, most_m);
}

bool ContactDetector::RestsOn(const Deck& deck, const Eigen::Vector3d& feet,
                              const Eigen::Vector3d& velocity) const {
  const Eigen::Vector3d offset = feet - deck.position;
  return offset.z() < options_.height_m && offset.head<2>().norm() < options_.reach_m &&
         std::abs(velocity.z() - deck.velocity.z()) < options_.speed_mps;
}

void ContactDetector::Reset() {
  resting_since_.reset();
  contact_z_m_.reset();
}

}  // namespace kestrel
