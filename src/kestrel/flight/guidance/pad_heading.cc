// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/pad_heading.h"

#include <algorithm>
#include <cmath>

#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

constexpr double kWalk = Radians(3);  // per square root of a second
constexpr double kOtherPad = 25;      // squared, in variances
constexpr int kMostContradictions = 8;

}  // namespace

void PadHeading::Add(Time time, double heading, double sigma, int symmetry) {
  if (symmetry <= 0 || !std::isfinite(heading) || !(sigma > 0)) return;
  const double period = kFullTurn / symmetry;
  const double noise = sigma * sigma;
  const double expected = seen_ ? VarianceAt(time) : 0;
  const double error = std::remainder(heading - heading_, period);
  const bool is_contradiction = seen_ && error * error > kOtherPad * (expected + noise);
  // A frame that shows less of the heading does not refute one that contradicts it.
  if (is_contradiction) ++contradictions_;
  if (!is_contradiction && period >= period_) contradictions_ = 0;
  const bool is_new = !seen_ || period > period_ || contradictions_ > kMostContradictions;
  if (is_contradiction && !is_new) return;
  const double gain = is_new ? 1 : expected / (expected + noise);
  heading_ = is_new ? heading : heading_ + gain * error;
  variance_ = gain * noise;
  if (is_new) period_ = period;
  seen_ = time;
}

double PadHeading::VarianceAt(Time time) const {
  return variance_ + kWalk * kWalk * std::max(ToSeconds(time - *seen_), 0.0);
}

std::optional<TargetEstimate> PadHeading::At(Time time) const {
  if (!seen_) return std::nullopt;
  TargetEstimate estimate;
  estimate.time = time;
  estimate.motion.mean(TurnState::kYaw) = heading_;
  estimate.motion.covariance(TurnState::kYaw, TurnState::kYaw) = VarianceAt(time);
  estimate.yaw_period = period_;
  return estimate;
}

}  // namespace kestrel
