// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/disturbance_observer.h"

#include <algorithm>
#include <cmath>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/poses/gravity.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;

// Time constant of the low pass: an error of the delay must not swing.
constexpr double kFilter_s = 0.5;
constexpr double kFilterPerDelay = 4;
constexpr double kMaxRest = 4;  // m/s^2
// A control that demands more than this (m/s^2, 45 degrees) is at its tilt limit.
constexpr double kMaxDemand = kGravity;

}  // namespace

std::vector<std::string> VelocityControl::Validate() const {
  std::vector<std::string> violations;
  Require(p, Range{0, 20}, "p", &violations);
  Require(i, Range{0, 20}, "i", &violations);
  Require(d, Range{0, 0.9}, "d", &violations);
  return violations;
}

void DisturbanceObserver::Observe(const Sample& sample, double seconds, double delay_s) {
  const Vector2d demand = sample.commanded + control_.p * sample.slip;
  if (demand.norm() > kMaxDemand) return;
  const double filter_s = std::max(kFilter_s, kFilterPerDelay * delay_s);
  const Vector2d thrust = demand - control_.d * sample.acceleration;
  const Vector2d rest = thrust - sample.acceleration - air_.At(sample.velocity);
  rest_ -= seconds * control_.i * sample.slip;
  rest_ += (1 - std::exp(-seconds / filter_s)) * (rest - rest_);
  const double size = rest_.norm();
  if (size > kMaxRest) rest_ *= kMaxRest / size;
}

// The sum stays as it was.
void DisturbanceObserver::SetAir(const AirForce& air, const Vector2d& velocity) {
  rest_ += air_.At(velocity) - air.At(velocity);
  air_ = air;
}

Vector2d DisturbanceObserver::FeedForward(const Vector2d& velocity,
                                          const Vector2d& acceleration) const {
  return air_.At(velocity) + rest_ + control_.d * acceleration;
}

}  // namespace kestrel
