// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/carried_proof.h"

#include <algorithm>

#include "kestrel/core/poses/gravity.h"

namespace kestrel {
namespace {

// ArduCopter's land detector takes no ground that accelerates more. A deck that turns more slowly
// is left to it.
constexpr double kAcceleration = 1;  // m/s^2
// Share of the acceleration that the lean does not explain.
constexpr double kUnexplained = 0.6;
// An estimate is 0.12 m/s wrong after the shock of touch-down.
constexpr double kRises_mps = 0.25;
constexpr double kLongestGap_s = 0.2;

bool AcceleratesWithoutLean(const CarriedProof::Motion& motion) {
  const double size = motion.acceleration.norm();
  if (size < kAcceleration) return false;
  const Eigen::Vector2d by_lean = kGravity / motion.thrust_axis.z() * motion.thrust_axis.head<2>();
  return by_lean.dot(motion.acceleration) / size < (1 - kUnexplained) * size;
}

}  // namespace

void CarriedProof::Observe(Time now, const Motion& motion) {
  const double step_s = last_ ? std::min(ToSeconds(now - *last_), kLongestGap_s) : 0;
  last_ = now;
  if (AcceleratesWithoutLean(motion) || motion.climb_mps > kRises_mps) seconds_ += step_s;
}

void CarriedProof::Reset() { *this = {}; }

}  // namespace kestrel
