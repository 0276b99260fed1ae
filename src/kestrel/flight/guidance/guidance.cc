// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/guidance.h"

#include <algorithm>
#include <cmath>

#include "kestrel/core/base/options.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/flight/guidance/since.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// After so long without a report the mode is not known: the autopilot reports it once a second.
constexpr double kMaxModeAge_s = 3.5;
constexpr double kLongestStep_s = 0.2;
// Obedience: the change of the velocity over this time, and the least change (m/s^2) that counts.
constexpr double kTrend_s = 1;
constexpr double kLeastObedience = 0.5;
constexpr double kBeyondLimits_s = 1;     // a demand beyond the limits counts after so long
constexpr double kLeastAcceleration = 1;  // m/s^2; every autopilot is set up for more

constexpr const char* kWaits = "waits for the pilot to give the mode";
constexpr const char* kWasGuided = "the mode was on already: leave it and give it anew";

bool IsFinite(const UavState& uav) {
  return uav.world_from_body.translation.allFinite() &&
         uav.world_from_body.rotation.coeffs().allFinite() && uav.velocity_in_world.allFinite();
}

bool IsFinite(const TargetEstimate& target) {
  return target.motion.mean.allFinite() && target.motion.covariance.diagonal().allFinite();
}

}  // namespace

Guidance::Guidance(const GuidanceOptions& options, const std::optional<Vector2d>& place)
    : options_(Checked(options)),
      has_place_(place.has_value()),
      limits_(options.limits, place.value_or(Vector2d::Zero())),
      model_(options.model),
      stale_(options.stale),
      pursuit_(options),
      demand_(options.limits),
      reason_(kWaits),
      may_stream_(options.stream_before_start),
      place_(place.value_or(Vector2d::Zero())) {}

void Guidance::SetFenceCenter(const Vector2d& center) {
  has_fence_center_ = true;
  limits_.set_center(center);
}

void Guidance::Rearm() {
  if (!is_active_) may_stream_ = options_.stream_before_start;
}

GuidanceOutput Guidance::Update(const GuidanceInput& input) {
  if (input.target && !IsFinite(*input.target)) {
    GuidanceInput without = input;
    without.target.reset();
    return Update(without);
  }
  if (!HasLink(input)) {
    last_ = input.now;
    sent_.reset();
    return Output(std::nullopt, GuidanceRequest::kNone);
  }
  FollowMode(input);
  WatchDemand(input);
  GuidanceOutput output;
  if (!is_active_) {
    output = Idle(input);
  } else if (!input.uav || !IsFinite(*input.uav)) {
    output = Blind(input);
  } else {
    output = Fly(input);
  }
  sent_ = output.set_point;
  last_ = input.now;
  return output;
}

// True when there is a link and the mode is known. After a long gap both are waited for: the
// autopilot may have left the mode meanwhile, and a set-point could bring PX4 back into it.
bool Guidance::HasLink(const GuidanceInput& input) {
  const bool is_gone = !input.is_link_up || !(input.mode_age_s <= kMaxModeAge_s);
  if (is_gone) {
    if (!link_lost_ && is_active_) reason_ = "the link is gone";
    Remember(true, input.now, &link_lost_);
    return false;
  }
  if (IsLongerThan(options_.lose_link_s, link_lost_, input.now)) mode_wanted_since_ = input.now;
  link_lost_.reset();
  if (!mode_wanted_since_) return true;
  if (input.mode_age_s > ToSeconds(input.now - *mode_wanted_since_)) return false;
  mode_wanted_since_.reset();
  ResumeAfterLink();
  pursuit_.Reset();
  return true;
}

void Guidance::FollowMode(const GuidanceInput& input) {
  const bool was_guided = was_guided_.value_or(input.is_guided);
  if (!was_guided_ && input.is_guided) reason_ = kWasGuided;
  was_guided_ = input.is_guided;
  if (input.is_guided && !was_guided) Start(input);
  if (!input.is_guided && was_guided) {
    End(phase_ == GuidancePhase::kLanded ? "landed; guidance has ended"
                                         : "the mode was left: give it anew to begin again");
    has_given_up_ = false;
  }
}

void Guidance::Start(const GuidanceInput& input) {
  may_stream_ = false;
  has_given_up_ = true;  // until all checks are passed
  if (!input.uav || !IsFinite(*input.uav)) return End("refused: the UAV's position is not known");
  if (!input.is_armed || input.is_landed) {
    has_given_up_ = false;  // there is nothing to hold on the ground
    return End("refused: the UAV is on the ground");
  }
  const Vector3d& position = input.uav->world_from_body.translation;
  if (!has_place_) place_ = position.head<2>();
  if (!has_fence_center_) limits_.set_center(place_);
  if (!limits_.Contains(position)) {
    return End("refused: the UAV is outside of the geofence or above the ceiling");
  }
  has_given_up_ = false;
  is_active_ = true;
  last_ = input.now;
  poses_lost_.reset();
  camera_lost_.reset();
  disobeys_since_.reset();
  velocity_trend_ = input.uav->velocity_in_world;
  beyond_since_.reset();
  pursuit_.Reset();
  Begin(input);
}

void Guidance::End(const char* reason) {
  is_active_ = false;
  if (phase_ != GuidancePhase::kLanded) phase_ = GuidancePhase::kIdle;
  reason_ = reason;
}

void Guidance::Enter(GuidancePhase phase, const char* reason) {
  phase_ = phase;
  reason_ = reason;
  entered_ = last_;
}

double Guidance::SecondsSinceLast(Time now) const {
  return std::clamp(ToSeconds(now - last_), 0.0, kLongestStep_s);
}

GuidanceOutput Guidance::Idle(const GuidanceInput& input) {
  if (input.uav && IsFinite(*input.uav)) {
    model_.Observe(input.now, input.uav->velocity_in_world,
                   input.uav->world_from_body.rotation * Vector3d::UnitZ(), std::nullopt,
                   input.link_delay_s);
  }
  if (has_given_up_) {
    const bool can_hold = input.uav || input.can_hold;
    return Output(std::nullopt, can_hold ? GuidanceRequest::kHold : GuidanceRequest::kLand);
  }
  if (!may_stream_ || input.is_guided || !input.uav) {
    return Output(std::nullopt, GuidanceRequest::kNone);
  }
  SetPoint hold;
  hold.yaw = HeadingOf(input.uav->world_from_body.rotation);
  return Output(hold, GuidanceRequest::kNone);
}

// Without a pose: flies on level for a moment, then stands still, then gives up. On the deck there
// is nothing to give up: the autopilot would hold its place with the motors on.
GuidanceOutput Guidance::Blind(const GuidanceInput& input) {
  Remember(true, input.now, &poses_lost_);
  model_.Forgo();
  GuidanceRequest request = GuidanceRequest::kNone;
  if (phase_ == GuidancePhase::kLanded) {
    if (GivesUp(input)) return Idle(input);
    request = RequestBlind(input);
  } else if (IsLongerThan(options_.lose_pose_s, poses_lost_, input.now)) {
    has_given_up_ = true;
    End("the poses have stopped: gave up");
    return Idle(input);
  }
  SetPoint on = sent_.value_or(SetPoint());
  on.acceleration.setZero();
  on.yaw_rate.reset();
  if (phase_ != GuidancePhase::kLanded) on = stale_.Level(on);
  if (IsLongerThan(GuidanceOptions::kHoldPose_s, poses_lost_, input.now)) {
    reason_ = "the poses have stopped";
    if (phase_ != GuidancePhase::kLanded) {
      on.velocity.setZero();
      on.place.reset();
    }
  }
  return Output(on, request);
}

// The request in contact without a pose: LAND, and where that does not end it, disarming.
GuidanceRequest Guidance::RequestBlind(const GuidanceInput& input) const {
  const double wait_s = options_.lose_pose_s + options_.disarm_carried_s;
  if (options_.disarm_carried_s > 0 && IsLongerThan(wait_s, poses_lost_, input.now)) {
    return GuidanceRequest::kDisarm;
  }
  return IsLongerThan(options_.lose_pose_s, poses_lost_, input.now) ? GuidanceRequest::kLand
                                                                    : GuidanceRequest::kNone;
}

GuidanceOutput Guidance::Fly(const GuidanceInput& input) {
  if (IsLongerThan(GuidanceOptions::kHoldPose_s, poses_lost_, input.now)) ResumeAfterPoses();
  poses_lost_.reset();
  if (GivesUp(input)) return Idle(input);
  const Wish wish = Choose(input);
  if (!is_active_) return Idle(input);
  const Vector3d& position = input.uav->world_from_body.translation;
  const Vector3d& velocity = input.uav->velocity_in_world;
  SetPoint limited = limits_.Limited(wish.set_point, position, wish.follows_target);
  // On the deck both autopilots look for a velocity downwards.
  if (wish.is_flying) stale_.SetPlace(position, velocity, input.link_delay_s, &limited);
  model_.Observe(input.now, velocity, input.uav->world_from_body.rotation * Vector3d::UnitZ(),
                 wish.is_flying ? std::optional(limited) : std::nullopt, input.link_delay_s);
  return Output(limited, wish.request);
}

// True when guidance ends although the pilot has not left the mode.
bool Guidance::GivesUp(const GuidanceInput& input) {
  if (!input.is_armed) {
    End(phase_ == GuidancePhase::kLanded ? "landed and disarmed" : "the motors are off");
    return true;
  }
  if (phase_ == GuidancePhase::kLanded) return false;
  const char* reason = nullptr;
  Remember(!input.is_camera_up, input.now, &camera_lost_);
  if (IsLongerThan(options_.lose_camera_s, camera_lost_, input.now)) {
    reason = "no new images: gave up";
  }
  if (!Obeys(input)) reason = "the autopilot does not obey the set-points: gave up";
  if (options_.cannot_follow_s > 0 &&
      IsLongerThan(options_.cannot_follow_s, beyond_since_, input.now)) {
    reason = "cannot keep up with the target: gave up";
  }
  if (const char* own = WhyGiveUp(input)) reason = own;
  if (!reason) return false;
  has_given_up_ = true;
  End(reason);
  return true;
}

// True unless the velocity is far from the commanded one and does not even approach it.
bool Guidance::Obeys(const GuidanceInput& input) {
  const Vector3d& velocity = input.uav->velocity_in_world;
  const double part = std::min(ToSeconds(input.now - last_) / kTrend_s, 1.0);
  velocity_trend_ += part * (velocity - velocity_trend_);
  const Vector3d error = sent_ ? Vector3d(sent_->velocity - velocity) : Vector3d::Zero();
  const double size = error.norm();
  const double nearer = (velocity - velocity_trend_).dot(error) / kTrend_s;
  const double least = std::min(kLeastObedience * size, kLeastAcceleration);
  const bool disobeys = size > GuidanceOptions::kDisobey_mps && nearer < least;
  Remember(disobeys, input.now, &disobeys_since_);
  return !IsLongerThan(GuidanceOptions::kDisobey_s, disobeys_since_, input.now);
}

// Compares the demand of target and wind with the limits, whether or not guidance flies. A UAV that
// is above the target keeps up with it, whatever is estimated.
void Guidance::WatchDemand(const GuidanceInput& input) {
  if (!input.target) {
    demand_.Reset();
    beyond_since_.reset();
    return;
  }
  const TurnState& motion = input.target->motion;
  const FollowingDemand& demand =
      demand_.Update(input.now, motion.velocity(), AccelerationAhead(motion, 0), model_.air());
  bool is_behind = true;
  if (is_active_ && input.uav && IsFinite(*input.uav)) {
    is_behind = IsBehind(input);
  }
  Remember(demand.is_beyond_limits() && is_behind, input.now, &beyond_since_);
}

bool Guidance::CannotFollow() const { return IsLongerThan(kBeyondLimits_s, beyond_since_, last_); }

GuidanceOutput Guidance::Output(const std::optional<SetPoint>& set_point,
                                GuidanceRequest request) const {
  return {set_point, phase_, request, reason_, CannotFollow()};
}

}  // namespace kestrel
