// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/target_jump.h"

#include <algorithm>
#include <cmath>

namespace kestrel {
namespace {

bool IsJump(const TurnState& before, const TurnState& now, double seconds) {
  constexpr double kSigmas = 2, kWalk_mps = 1;
  const double speed = std::max(kWalk_mps, before.velocity().head<2>().norm());
  const double sigma_m = std::sqrt(before.covariance.topLeftCorner<2, 2>().trace());
  const Eigen::Vector3d jump = now.position() - before.position();
  return jump.head<2>().norm() > kSigmas * std::hypot(sigma_m, speed * seconds);
}

}  // namespace

bool TargetJump::Update(const GuidanceInput& input) {
  const Sight sight{input.target->motion, input.now - DurationFromSeconds(input.target_age_s)};
  if (last_ && IsJump(last_->motion, sight.motion, ToSeconds(sight.time - last_->time))) {
    return true;
  }
  last_ = sight;
  return false;
}

}  // namespace kestrel
