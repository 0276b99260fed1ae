// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/stale_safety.h"

#include <algorithm>
#include <cmath>

namespace kestrel {
namespace {

// The UAV comes to rest above this part of its height, and above this height: errors of the deck's
// height, and the overshoot of the control.
constexpr double kRestPart = 0.4;
constexpr double kMargin_m = 0.15;

}  // namespace

double StaleSafety::MaxSink(double height_m, double link_delay_s) const {
  const double room_m = std::max(std::min((1 - kRestPart) * height_m, height_m - kMargin_m), 0.0);
  if (options_.sends_places()) return options_.height_gain * room_m;
  const double braking = options_.vertical_braking;
  const double lead_s = options_.timeout_s + link_delay_s + braking / (2 * options_.vertical_jerk);
  const double coast = braking * lead_s;  // m/s
  return std::sqrt(coast * coast + 2 * braking * room_m) - coast;
}

void StaleSafety::SetPlace(const Eigen::Vector3d& position, const Eigen::Vector3d& velocity,
                           double link_delay_s, SetPoint* set_point) const {
  if (!options_.sends_places()) return;
  const Eigen::Vector3d gain(options_.position_gain, options_.position_gain, options_.height_gain);
  set_point->place = position + link_delay_s * velocity + set_point->velocity.cwiseQuotient(gain);
}

SetPoint StaleSafety::Level(SetPoint set_point) const {
  set_point.acceleration.setZero();
  const double sink = std::min(set_point.velocity.z(), 0.0);
  set_point.velocity.z() -= sink;
  if (set_point.place) set_point.place->z() -= sink / options_.height_gain;
  return set_point;
}

}  // namespace kestrel
