// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/landing_guidance.h"

#include <algorithm>
#include <cmath>

#include "kestrel/core/base/options.h"
#include "kestrel/flight/guidance/since.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kHeightGain = 1;  // climb rate per metre below the wanted height
constexpr double kResting_mps =
    0.25;  // a UAV that sinks more slowly than this on command to descend rests
constexpr double kCommandedDown_mps = 0.3;
constexpr double kMaxClosing_mps = 1;  // if it moves faster over the target it does not descend
// Offset, in cones, at which following ends, and at which the last bit ends.
constexpr double kFollowCones = 4;
constexpr double kCommitCones = 3;
// After so long without a report the mode is not known: the autopilot reports it once a second.
constexpr double kMaxModeAge_s = 3.5;
constexpr double kLongestStep_s = 0.2;
constexpr double kCommitAcceleration = 0.2;  // m/s^2, downwards
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

LandingGuidance::LandingGuidance(const GuidanceOptions& options,
                                 const std::optional<Vector2d>& place)
    : options_(Checked(options)),
      has_place_(place.has_value()),
      limits_(options.limits, place.value_or(Vector2d::Zero())),
      model_(options.model),
      stale_(options.stale),
      pursuit_(options),
      search_(options),
      demand_(options.limits),
      contact_(options.contact),
      stay_(options),
      heading_(options),
      reason_(kWaits),
      may_stream_(options.stream_before_start),
      place_(place.value_or(Vector2d::Zero())) {}

void LandingGuidance::SetFenceCenter(const Vector2d& center) {
  has_fence_center_ = true;
  limits_.set_center(center);
}

void LandingGuidance::Rearm() {
  if (!is_active_) may_stream_ = options_.stream_before_start;
}

GuidanceOutput LandingGuidance::Update(const GuidanceInput& input) {
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
bool LandingGuidance::HasLink(const GuidanceInput& input) {
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
  if (IsLow() || phase_ == GuidancePhase::kFollow) GoAround("the link was gone");
  pursuit_.Reset();
  return true;
}

void LandingGuidance::FollowMode(const GuidanceInput& input) {
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

void LandingGuidance::Start(const GuidanceInput& input) {
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
  heading_.Start(LevelHeadingOf(input.uav->world_from_body.rotation));
  last_ = input.now;
  go_arounds_ = 0;
  poses_lost_.reset();
  camera_lost_.reset();
  disobeys_since_.reset();
  velocity_trend_ = input.uav->velocity_in_world;
  contact_.Reset();
  contact_since_.reset();
  beyond_since_.reset();
  pursuit_.Reset();
  road_.Reset();
  timing_.Reset();
  search_.Start(place_);
  Enter(GuidancePhase::kSearch, "the pilot has given the mode");
}

void LandingGuidance::End(const char* reason) {
  is_active_ = false;
  if (phase_ != GuidancePhase::kLanded) phase_ = GuidancePhase::kIdle;
  reason_ = reason;
}

GuidanceOutput LandingGuidance::Idle(const GuidanceInput& input) {
  if (input.uav && IsFinite(*input.uav)) {
    model_.Observe(input.now, input.uav->velocity_in_world,
                   input.uav->world_from_body.rotation * Vector3d::UnitZ(), std::nullopt,
                   input.link_delay_s);
  }
  if (has_given_up_) return Output(std::nullopt, GuidanceRequest::kHold);
  if (!may_stream_ || input.is_guided || !input.uav) {
    return Output(std::nullopt, GuidanceRequest::kNone);
  }
  SetPoint hold;
  hold.yaw = HeadingOf(input.uav->world_from_body.rotation);
  return Output(hold, GuidanceRequest::kNone);
}

// Without a pose: flies on level for a moment, then stands still, then gives up. On the deck there
// is nothing to give up: the autopilot would hold its place with the motors on.
GuidanceOutput LandingGuidance::Blind(const GuidanceInput& input) {
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
GuidanceRequest LandingGuidance::RequestBlind(const GuidanceInput& input) const {
  const double wait_s = options_.lose_pose_s + options_.disarm_carried_s;
  if (options_.disarm_carried_s > 0 && IsLongerThan(wait_s, poses_lost_, input.now)) {
    return GuidanceRequest::kDisarm;
  }
  return IsLongerThan(options_.lose_pose_s, poses_lost_, input.now) ? GuidanceRequest::kLand
                                                                    : GuidanceRequest::kNone;
}

GuidanceOutput LandingGuidance::Fly(const GuidanceInput& input) {
  if (IsLongerThan(GuidanceOptions::kHoldPose_s, poses_lost_, input.now) && IsLow()) {
    GoAround("the poses had stopped");
  }
  poses_lost_.reset();
  if (GivesUp(input)) return Idle(input);
  if (input.deck) {
    timing_.Observe(input.deck->time, input.deck->height_m, input.deck->normal);
  }
  heading_.Update(input.now, LevelHeadingOf(input.uav->world_from_body.rotation), input.target,
                  input.link_delay_s);
  const Situation now = Look(input);
  ChoosePhase(input, now);
  if (!is_active_) return Idle(input);
  SetPoint wanted;
  if (phase_ == GuidancePhase::kLanded) {
    wanted =
        stay_.Rest(input.now, input.uav->world_from_body.rotation, now.velocity, model_.delay_s());
  } else {
    wanted = input.target ? Pursue(input, now) : Search(input, now);
  }
  if (!wanted.yaw) {
    wanted.yaw = heading_.yaw();
    if (heading_.is_known()) wanted.yaw_rate = heading_.yaw_rate();
  }
  const Vector3d& position = input.uav->world_from_body.translation;
  const bool is_flying = phase_ != GuidancePhase::kLanded;
  SetPoint limited = limits_.Limited(wanted, position, input.target.has_value() || !is_flying);
  // On the deck both autopilots look for a velocity downwards.
  if (is_flying) stale_.SetPlace(position, now.velocity, input.link_delay_s, &limited);
  model_.Observe(input.now, now.velocity, input.uav->world_from_body.rotation * Vector3d::UnitZ(),
                 is_flying ? std::optional(limited) : std::nullopt, input.link_delay_s);
  const GuidanceRequest request = is_flying
                                      ? GuidanceRequest::kNone
                                      : stay_.Request(input.now, input.is_landed, contact_since_);
  return Output(limited, request);
}

// True when guidance ends although the pilot has not left the mode.
bool LandingGuidance::GivesUp(const GuidanceInput& input) {
  if (!input.is_armed) {
    End(phase_ == GuidancePhase::kLanded ? "landed and disarmed" : "the motors are off");
    return true;
  }
  if (phase_ == GuidancePhase::kLanded) return false;
  const char* reason = nullptr;
  const bool waits_for_heading =
      phase_ == GuidancePhase::kFollow || phase_ == GuidancePhase::kDescend;
  Remember(!input.is_camera_up, input.now, &camera_lost_);
  if (IsLongerThan(options_.lose_camera_s, camera_lost_, input.now)) {
    reason = "no new images: gave up";
  }
  if (!Obeys(input)) reason = "the autopilot does not obey the set-points: gave up";
  if (phase_ == GuidancePhase::kSearch && search_.IsOver(input.now)) {
    reason = "the target was not found again: gave up";
  }
  if (options_.cannot_follow_s > 0 &&
      IsLongerThan(options_.cannot_follow_s, beyond_since_, input.now)) {
    reason = "cannot keep up with the target: gave up";
  }
  if (heading_.IsOverdue(input.now, waits_for_heading)) {
    reason = heading_.is_known() ? "the nose does not come to the heading over the pad: gave up"
                                 : "the pad's heading is not known: gave up";
  }
  if (!reason) return false;
  has_given_up_ = true;
  End(reason);
  return true;
}

// True unless the velocity is far from the commanded one and does not even approach it.
bool LandingGuidance::Obeys(const GuidanceInput& input) {
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
void LandingGuidance::WatchDemand(const GuidanceInput& input) {
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
    const Situation now = Look(input);
    is_behind = now.off_m > 2 * Cone(now.height_m) || now.slip_mps > 2 * kMaxClosing_mps;
  }
  Remember(demand.is_beyond_limits() && is_behind, input.now, &beyond_since_);
}

bool LandingGuidance::CannotFollow() const {
  return IsLongerThan(kBeyondLimits_s, beyond_since_, last_);
}

LandingGuidance::Situation LandingGuidance::Look(const GuidanceInput& input) const {
  Situation now;
  now.feet = input.uav->world_from_body * Vector3d(0, 0, -options_.leg_m);
  now.velocity = input.uav->velocity_in_world;
  if (!input.target) return now;
  const TurnState& target = input.target->motion;
  const Vector3d from_target = now.feet - target.position();
  now.height_m = from_target.z();
  now.off_m = from_target.head<2>().norm();
  now.slip_mps = (target.velocity() - now.velocity).head<2>().norm();
  now.is_in_sight = input.is_camera_up && input.target_age_s <= options_.sight_s;
  now.is_known = input.target->position_sigma_m() <= options_.max_sigma_m;
  const double climb_sigma = std::sqrt(std::max(target.covariance(5, 5), 0.0));
  now.is_credible =
      std::abs(target.velocity().z()) <= GuidanceOptions::kMaxTargetClimb_mps + 2 * climb_sigma;
  return now;
}

void LandingGuidance::ChoosePhase(const GuidanceInput& input, const Situation& now) {
  if (FindContact(input, now)) return;
  if (!input.target) {
    if (IsLow()) ++go_arounds_;
    if (phase_ != GuidancePhase::kSearch) {
      search_.StartAfterLoss(input.now, road_, place_);
      pursuit_.Reset();
      Enter(GuidancePhase::kSearch, search_.step());
    }
    return;
  }
  const TurnState& target = input.target->motion;
  place_ = target.position().head<2>();
  if (now.is_in_sight) {
    road_.Add(input.now, place_, target.velocity().head<2>(), target.turn_rate());
  }
  if (phase_ == GuidancePhase::kSearch) Enter(GuidancePhase::kApproach, "the target is found");
  if (phase_ == GuidancePhase::kGoAround && now.height_m >= options_.sight_height_m) {
    Enter(GuidancePhase::kApproach, "high enough to come again");
  }
  ChooseAbove(now);
  ChooseDescent(input, now);
}

// Chooses between approach, follow and the beginning of the descent.
void LandingGuidance::ChooseAbove(const Situation& now) {
  const double cone_m = Cone(now.height_m);
  if (phase_ == GuidancePhase::kApproach && now.off_m < cone_m && now.slip_mps < kMaxClosing_mps) {
    Enter(GuidancePhase::kFollow, "above the target");
  }
  if (phase_ != GuidancePhase::kFollow) return;
  if (now.off_m > kFollowCones * cone_m) {
    Enter(GuidancePhase::kApproach, "too far from the target");
  } else if (now.off_m < cone_m && MayDescend(now)) {
    if (heading_.is_wanted() && !heading_.is_known()) {
      reason_ = "waits above the target: the pad's heading is not known";
    } else {
      Enter(GuidancePhase::kDescend, "above the target, which is in sight");
    }
  }
}

bool LandingGuidance::MayDescend(const Situation& now) const {
  return now.is_known && now.is_credible && now.is_in_sight && now.slip_mps < kMaxClosing_mps;
}

// Chooses within the descent: on down to the deck, or up again.
void LandingGuidance::ChooseDescent(const GuidanceInput& input, const Situation& now) {
  const double cone_m = Cone(now.height_m);
  if (phase_ == GuidancePhase::kDescend) {
    if (!now.is_known) return GoAround("the target is not known well enough");
    if (!now.is_credible) return GoAround("the target rises or sinks: not a deck");
    if (now.off_m > 2 * cone_m) {
      if (now.height_m < options_.sight_height_m) return GoAround("too far beside the target");
      return Enter(GuidancePhase::kApproach, "too far beside the target");
    }
    if (!now.is_in_sight && now.height_m < options_.sight_height_m) {
      return GoAround("low, and the target is not in sight");
    }
    if (now.height_m < options_.commit_height_m && now.off_m < cone_m && heading_.is_reached()) {
      Enter(GuidancePhase::kCommit, "near the deck, within the cone");
    }
  }
  if (phase_ != GuidancePhase::kCommit) return;
  // A UAV that does not sink any more stands on the deck, where the camera may see nothing.
  const bool sinks = now.velocity.z() - input.target->motion.velocity().z() < -kResting_mps;
  if (sinks && !(input.target_age_s <= GuidanceOptions::kCommitSight_s)) {
    return GoAround("near the deck, and the target was not in sight for too long");
  }
  if (now.is_in_sight && now.off_m > kCommitCones * cone_m) GoAround("beside the deck");
  if (now.height_m > 2 * options_.commit_height_m) GoAround("has risen from the deck");
}

// True when the UAV stands on the deck: by its rest against the deck, or because the autopilot
// reports it.
bool LandingGuidance::FindContact(const GuidanceInput& input, const Situation& now) {
  // A UAV without a command to descend may hover near the deck.
  const bool is_commanded_down = sent_ && sent_->velocity.z() < -kCommandedDown_mps;
  std::optional<ContactDetector::Deck> deck;
  if (input.target && is_commanded_down) {
    deck = ContactDetector::Deck{input.target->motion.position(), input.target->motion.velocity()};
  }
  const bool was_in_contact = phase_ == GuidancePhase::kLanded;
  const bool may_touch = IsLow() || was_in_contact;
  if (!may_touch) contact_.Reset();
  const bool touches = may_touch && contact_.Update(input.now, now.feet, now.velocity, deck);
  Remember(touches, input.now, &contact_since_);
  if (touches || (may_touch && input.is_landed)) {
    if (!was_in_contact) {
      stay_.Reset();
      Enter(GuidancePhase::kLanded, "contact with the deck");
    }
    return true;
  }
  if (was_in_contact) GoAround("has lost contact with the deck");
  if (input.is_landed) End("the UAV is on the ground");
  return false;
}

SetPoint LandingGuidance::Search(const GuidanceInput& input, const Situation& now) {
  const double seconds = std::clamp(ToSeconds(input.now - last_), 0.0, kLongestStep_s);
  const Vector2d place = search_.Advance(input.now, road_, now.feet.head<2>(), seconds);
  if (*search_.step() != '\0') reason_ = search_.step();
  SetPoint command = pursuit_.To(place, {now.feet.head<2>(), now.velocity.head<2>()}, &model_,
                                 options_.limits.max_speed_mps);
  command.velocity.z() = kHeightGain * (options_.search_altitude_m - now.feet.z());
  return command;
}

SetPoint LandingGuidance::Pursue(const GuidanceInput& input, const Situation& now) {
  SetPoint command =
      pursuit_.Above(*input.target, {now.feet.head<2>(), now.velocity.head<2>()}, &model_);
  command.velocity.z() = ClimbRate(input, now);
  if (phase_ != GuidancePhase::kCommit) {
    const double most = stale_.MaxSink(now.height_m, input.link_delay_s);
    command.velocity.z() = std::max(command.velocity.z(), -most);
  }
  command.velocity.z() += timing_.Climb(input.now, model_.delay_s());
  // Out of sight only the last bit goes down. Near the deck the descent stops early, because a UAV
  // takes a while to stop; it goes around when that has lasted.
  const double patience_s =
      now.height_m < options_.sight_height_m ? 0.5 * options_.sight_s : options_.sight_s;
  const bool is_seen = now.is_in_sight && input.target_age_s <= patience_s;
  if (!is_seen && phase_ != GuidancePhase::kCommit) {
    command.velocity.z() = std::max(command.velocity.z(), 0.0);
  }
  return command;
}

double LandingGuidance::ClimbRate(const GuidanceInput& input, const Situation& now) {
  const double sink =
      std::max(GuidanceOptions::kSinkGain * now.height_m, options_.touchdown_sink_mps);
  if (phase_ == GuidancePhase::kCommit) {
    // Ever faster: the autopilot then does not mistake the stop by the deck for its own braking.
    return -sink - kCommitAcceleration * ToSeconds(input.now - entered_);
  }
  if (phase_ == GuidancePhase::kDescend) {
    if (now.off_m >= Cone(now.height_m)) return 0;
    const auto wait_m = WaitHeight(input.now, now.height_m);
    return wait_m ? std::max(-sink, kHeightGain * (*wait_m - now.height_m)) : -sink;
  }
  const double top_m = options_.search_altitude_m - input.target->motion.position().z();
  const bool is_unknown = input.target->position_sigma_m() > 2 * options_.max_sigma_m;
  const double wanted_m =
      is_unknown ? top_m : std::max(options_.follow_height_m, GuidanceOptions::kGlide * now.off_m);
  return kHeightGain * (std::min(wanted_m, top_m) - now.height_m);
}

// Height below which the UAV does not go yet: before the deck is level, or without the heading.
std::optional<double> LandingGuidance::WaitHeight(Time now, double height_m) {
  const bool waits_for_deck = timing_.Waits(now, height_m);
  if (!heading_.is_reached()) {
    return std::max(TouchdownTiming::kWaitHeight_m, 2 * options_.commit_height_m);
  }
  return waits_for_deck ? std::optional(TouchdownTiming::kWaitHeight_m) : std::nullopt;
}

void LandingGuidance::Enter(GuidancePhase phase, const char* reason) {
  phase_ = phase;
  reason_ = reason;
  entered_ = last_;
}

void LandingGuidance::GoAround(const char* reason) {
  ++go_arounds_;
  timing_.Reset();
  Enter(GuidancePhase::kGoAround, reason);
}

double LandingGuidance::Cone(double height_m) const {
  return options_.cone_m + GuidanceOptions::kConeSlope * std::max(height_m, 0.0);
}

bool LandingGuidance::IsLow() const {
  return phase_ == GuidancePhase::kDescend || phase_ == GuidancePhase::kCommit;
}

GuidanceOutput LandingGuidance::Output(const std::optional<SetPoint>& set_point,
                                       GuidanceRequest request) const {
  return {set_point, phase_, request, reason_, CannotFollow()};
}

}  // namespace kestrel
