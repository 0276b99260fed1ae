// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/guidance/landing_guidance.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "kestrel/base/violations.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kHeightGain = 1;      // climb rate per metre that it is too low
constexpr double kMaxClosing_mps = 1;  // faster over the target it does not go down

// Speed at which to close in on something 'distance_m' away, and its derivative by the distance: in
// proportion to it while that can be braked, by the root further away.
struct Closing {
  double speed;
  double rate;
};
Closing ClosingSpeed(double distance_m, double gain, double braking) {
  const double reach = braking / (gain * gain);  // where the straight line touches the parabola
  if (distance_m <= reach) return {gain * distance_m, gain};
  const double speed = std::sqrt(braking * (2 * distance_m - reach));
  return {speed, braking / speed};
}

// How the target's velocity will change in its curve, 'ahead_s' from now.
Vector3d AccelerationAhead(const TurnState& motion, double ahead_s) {
  const Eigen::AngleAxisd turn(motion.turn_rate() * ahead_s, Vector3d::UnitZ());
  const Vector3d velocity = turn * Vector3d(motion.velocity());
  return motion.turn_rate() * Vector3d(-velocity.y(), velocity.x(), 0);
}

}  // namespace

const char* ToString(LandingPhase phase) {
  switch (phase) {
    case LandingPhase::kSearch:
      return "search";
    case LandingPhase::kApproach:
      return "approach";
    case LandingPhase::kDescend:
      return "descend";
    case LandingPhase::kCommit:
      return "commit";
  }
  return "";
}

std::vector<std::string> GuidanceOptions::Validate() const {
  std::vector<std::string> violations;
  RequireIn(search_altitude_m, 1, 100, "search_altitude_m", &violations);
  RequireIn(follow_height_m, 0.1, 100, "follow_height_m", &violations);
  RequireIn(glide, 0, 10, "glide", &violations);
  RequireIn(position_gain, 0.1, 5, "position_gain", &violations);
  RequireIn(braking, 0.1, 20, "braking", &violations);
  RequireIn(lead_s, 0, 1, "lead_s", &violations);
  RequireIn(smoothing_s, 0.01, 10, "smoothing_s", &violations);
  RequireIn(sink_gain, 0.05, 5, "sink_gain", &violations);
  RequireIn(max_sink_mps, 0.1, 10, "max_sink_mps", &violations);
  RequireIn(touchdown_sink_mps, 0.1, 10, "touchdown_sink_mps", &violations);
  RequireIn(cone_m, 0.01, 10, "cone_m", &violations);
  RequireIn(cone_slope, 0, 10, "cone_slope", &violations);
  RequireIn(commit_height_m, 0, 10, "commit_height_m", &violations);
  RequireIn(max_sigma_m, 0.01, 10, "max_sigma_m", &violations);
  return violations;
}

SetPoint LandingGuidance::Command(const UavState& uav,
                                  const std::optional<TargetEstimate>& target) {
  if (!target) {
    if (phase_ == LandingPhase::kDescend || phase_ == LandingPhase::kCommit) ++go_arounds_;
    phase_ = LandingPhase::kSearch;
    smoothed_.reset();
    return Search(uav);
  }
  const TurnState& motion = target->motion;
  place_ = motion.position().head<2>();
  ChoosePhase(uav, *target);
  const Vector2d offset = place_ - uav.feet_in_world.head<2>();
  const double distance_m = offset.norm();
  const Closing closing = ClosingSpeed(distance_m, options_.position_gain, options_.braking);
  const Vector2d towards = distance_m > 0 ? Vector2d(offset / distance_m) : Vector2d::Zero();
  const Vector3d velocity = Smoothed(*target);
  const Vector3d slip = velocity - uav.velocity_in_world;
  SetPoint command;
  command.velocity = velocity;
  command.velocity.head<2>() += closing.speed * towards;
  command.velocity.z() = ClimbRate(uav, *target);
  command.acceleration = AccelerationAhead(motion, options_.lead_s);
  command.acceleration.head<2>() += closing.rate * slip.head<2>();
  return command;
}

SetPoint LandingGuidance::Search(const UavState& uav) const {
  const Vector2d offset = place_ - uav.feet_in_world.head<2>();
  const double distance_m = offset.norm();
  const Closing closing = ClosingSpeed(distance_m, options_.position_gain, options_.braking);
  SetPoint command;
  if (distance_m > 0) command.velocity.head<2>() = closing.speed / distance_m * offset;
  command.acceleration.head<2>() = -closing.rate * uav.velocity_in_world.head<2>();
  command.velocity.z() = kHeightGain * (options_.search_altitude_m - uav.feet_in_world.z());
  return command;
}

// A low pass that turns with the target: it does not lag in curves.
Vector3d LandingGuidance::Smoothed(const TargetEstimate& target) {
  const Vector3d velocity = target.motion.velocity();
  if (!smoothed_) smoothed_ = {target.time, velocity};
  const double seconds = ToSeconds(target.time - smoothed_->time);
  const double part = 1 - std::exp(-seconds / options_.smoothing_s);
  const Vector3d turned = smoothed_->in_world + seconds * AccelerationAhead(target.motion, 0);
  smoothed_ = {target.time, turned + part * (velocity - turned)};
  return smoothed_->in_world;
}

void LandingGuidance::ChoosePhase(const UavState& uav, const TargetEstimate& target) {
  const Vector3d from_target = uav.feet_in_world - target.motion.position();
  const double off_m = from_target.head<2>().norm();
  const double height_m = from_target.z();
  const double slip_mps = (target.motion.velocity() - uav.velocity_in_world).head<2>().norm();
  const bool is_known = target.position_sigma_m() <= options_.max_sigma_m;
  const double cone_m = Cone(std::max(height_m, 0.0));
  if (phase_ == LandingPhase::kSearch) phase_ = LandingPhase::kApproach;
  if (phase_ == LandingPhase::kApproach && is_known && off_m < cone_m &&
      slip_mps < kMaxClosing_mps) {
    phase_ = LandingPhase::kDescend;
  }
  if (phase_ == LandingPhase::kDescend && height_m < options_.commit_height_m && off_m < cone_m) {
    phase_ = LandingPhase::kCommit;
  }
  if (phase_ == LandingPhase::kDescend && (!is_known || off_m > 2 * cone_m)) {
    phase_ = LandingPhase::kApproach;
    ++go_arounds_;
  }
}

double LandingGuidance::ClimbRate(const UavState& uav, const TargetEstimate& target) const {
  const Vector3d from_target = uav.feet_in_world - target.motion.position();
  const double off_m = from_target.head<2>().norm();
  const double height_m = from_target.z();
  const double sink =
      std::clamp(options_.sink_gain * height_m, options_.touchdown_sink_mps, options_.max_sink_mps);
  if (phase_ == LandingPhase::kCommit) return -sink;
  if (phase_ == LandingPhase::kDescend) return off_m < Cone(height_m) ? -sink : 0;
  const double top_m = options_.search_altitude_m - target.motion.position().z();
  const bool is_unknown = target.position_sigma_m() > 2 * options_.max_sigma_m;
  const double wanted_m =
      is_unknown ? top_m : std::max(options_.follow_height_m, options_.glide * off_m);
  return std::clamp(kHeightGain * (std::min(wanted_m, top_m) - height_m), -options_.max_sink_mps,
                    options_.max_sink_mps);
}

}  // namespace kestrel
