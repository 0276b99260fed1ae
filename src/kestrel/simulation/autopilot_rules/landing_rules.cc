// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/autopilot_rules/landing_rules.h"

#include <algorithm>
#include <cmath>

namespace kestrel {

double BrakingSpeed(double distance, double gain, double acceleration) {
  const double linear = acceleration / (gain * gain);
  if (distance <= linear) return gain * distance;
  return std::sqrt(2 * acceleration * (distance - 0.5 * linear));
}

Eigen::Vector2d BrakingVelocity(const Eigen::Vector2d& way, double gain, double acceleration,
                                double max_speed) {
  const double distance = way.norm();
  if (!(distance > 0)) return Eigen::Vector2d::Zero();
  return std::min(BrakingSpeed(distance, gain, acceleration), max_speed) / distance * way;
}

}  // namespace kestrel
