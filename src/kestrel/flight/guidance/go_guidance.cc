// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/go_guidance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/flight/guidance/keep_apart.h"
#include "kestrel/flight/guidance/since.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Part of the cone in which the UAV sinks: the camera of a hunt sees less to the sides than that of
// a landing.
constexpr double kConePart = 0.4;
// Above the height of the job: where the UAV waits until it is above the object, and where the job
// may begin.
constexpr double kWait_m = 0.8;
constexpr double kReach_m = 0.05;
// Largest offset of a gripper where it waits, and when it closes, now and a moment later; its speed
// relative to the object, and the uncertainty of the object's place then.
constexpr double kAim_m = 0.08;
constexpr double kGrip_m = 0.05;
constexpr double kAim_mps = 0.3;
constexpr double kGripDelay_s = 0.1;
constexpr double kGripSigma_m = 0.05;
constexpr double kAimWait_s = 20;      // for which it waits, and tries to grip
constexpr double kLastSink_mps = 0.4;  // at least: near by the camera does not see the object
constexpr double kLastGain = 2;        // 1/s: it brakes before the ground, and rises off it
// A UAV that sinks more slowly for so long on command to descend rests on something.
constexpr double kStandstill_mps = 0.05;
constexpr double kRests_s = 1;
constexpr double kTouches_s = 0.5;  // after which the ground takes the load
constexpr double kBelow_m = 1;  // from the UAV to the object, while it looks whether that is gone
// Near an object whose place is known so well the UAV flies on for this long without a sight.
constexpr double kLongestSight_s = 3;
constexpr double kSureSigma_m = 0.1;
constexpr double kRise_mps = 1;      // while it does not see an object below
constexpr double kLostSigmas = 2;    // of max_sigma_m: it climbs off
constexpr double kStands_mps = 0.2;  // at most, of an object that stands
constexpr double kLayer_m = 1.5;     // between the heights at which the UAVs of a team travel
constexpr double kClimbOff_m = 6;    // near the ground, from a UAV at work that goes first
constexpr double kClimbOff_s = 2;    // the same, by how they fly on: the climb takes that long
constexpr double kSame_m = 0.5;  // an object that stands is no further from where it was gripped
constexpr double kStrays_mps = 0.3;   // one that moves, from where it would be by its velocity
constexpr double kMostStray_m = 1.5;  // the same, at most: farther off it is another one
constexpr double kFarView_m = 0.5;    // below the height of travel: it rises no further
constexpr double kGone_s = 2;         // an object that is not seen for so long from above is gone
constexpr double kUnseen_s = 5;       // the same, of one that may never have been seen by this UAV

// True when a UAV that goes first is within the distance.
bool MustGiveWay(const Vector2d& place, std::span<const OtherUav> others, double distance_m) {
  return std::ranges::any_of(others, [&](const OtherUav& other) {
    return other.goes_first && (other.position - place).norm() < distance_m;
  });
}

bool IsSeen(const GuidanceInput& input) {
  return input.target && input.is_camera_up &&
         input.target_age_s <= GuidanceOptions::kCommitSight_s;
}

// False when the object is out of sight for too long to go on near it.
bool IsSureOf(const GuidanceInput& input) {
  if (input.target_age_s <= GuidanceOptions::kCommitSight_s) return true;
  return input.target_age_s <= kLongestSight_s && input.target->position_sigma_m() < kSureSigma_m;
}

const char* InWords(GoAction action) {
  switch (action) {
    case GoAction::kHover:
      return "done: has hovered above the goal";
    case GoAction::kLook:
      return "done: has looked at the goal";
    case GoAction::kDrop:
      return "done: the gripper is open";
    case GoAction::kPick:
      return "done: the object is gone from the ground";
  }
  return "";
}

// Options for small objects, which have no springs.
GuidanceOptions ForObjects(GuidanceOptions options) {
  options.model.meets_gusts = true;
  options.target_is_agile = true;
  return options;
}

void RequireAtMost(double value, double most, const char* key, const char* limit) {
  if (value <= most) return;
  throw InputError(fmt::format("{} is {:g}, expected at most {:g} ({})", key, value, most, limit));
}

}  // namespace

GoGuidance::GoGuidance(const GuidanceOptions& options, const GoJob& job)
    : DescentGuidance(ForObjects(options), std::nullopt), job_(job), delivery_(options) {
  RequireAtMost(options.search_radius_m, options.limits.geofence_radius_m,
                "guidance.search_radius_m", "limits.geofence_radius_m");
  RequireAtMost(job.height_m, options.search_altitude_m, "the height above the object",
                "guidance.search_altitude_m");
  if (job.target != GoTarget::kPlace) return;
  if (job.action == GoAction::kPick) {
    throw InputError("pick: expected an object, or what is marked; at a place nothing is seen");
  }
  const double least_m = options.limits.floor_m - options.leg_m;
  if (job.height_m >= least_m) return;
  throw InputError(fmt::format(
      "the height above a place, where nothing is seen, is {:g}, expected at least {:g} "
      "(limits.floor_m less guidance.leg_m)",
      job.height_m, least_m));
}

void GoGuidance::Begin(const GuidanceInput& input) {
  yaw_ = HeadingOf(input.uav->world_from_body.rotation);
  home_ = input.uav->world_from_body.translation.head<2>();
  confirmation_.Begin(input.order);
  Reset();
  StartSearch();
  if (job_.target == GoTarget::kMarked) Await("waits for a mark, and for its confirmation");
}

void GoGuidance::Reset() {
  ended_ = {};
  mark_ = failures_ = 0;
  carries_ = skips_ = false;
  has_gripped_ = is_open_ = is_done_ = false;
  fault_ = give_up_ = nullptr;
  motion_ = GuidanceRequest::kNone;
  waits_since_.reset();
  rests_since_.reset();
  gripped_.reset();
}

// A new confirmation begins anew.
void GoGuidance::TakeOrder(const GuidanceInput& input) {
  const char* refusal = IsSeen(input) ? nullptr : "refused: what is marked is not seen";
  const char* reason = confirmation_.Update(input.order, input.mark, refusal);
  if (reason != nullptr) return Await(reason);
  if (!confirmation_.is_new()) return;
  jump_.Reset();
  Reset();
  StartSearch();
}

void GoGuidance::Await(const char* reason) {
  confirmation_.Withdraw();
  waits_at_.reset();
  Enter(GuidancePhase::kLook, reason);
}

bool GoGuidance::AwaitsPerson() const {
  return job_.target == GoTarget::kMarked && confirmation_.mark() == 0;
}

// Until the gripper has closed: what it took is carried away.
bool GoGuidance::HasJumped(const GuidanceInput& input) {
  if (confirmation_.mark() == 0 || !IsSeen(input) || has_gripped_ || is_done_) return false;
  return jump_.Update(input);
}

void GoGuidance::ResumeAfterLink() {
  if (IsLow()) TryAgain("the link was gone");
}

void GoGuidance::ResumeAfterPoses() {
  if (IsLow()) TryAgain("the poses had stopped");
}

// Near the ground it climbs before it gives up.
const char* GoGuidance::WhyGiveUp(const GuidanceInput& input) {
  if (give_up_ != nullptr) return give_up_;
  if (phase() == GuidancePhase::kSearch && IsSearchOver(input.now)) {
    return "the object was not found again: gave up";
  }
  const bool is_high = phase() == GuidancePhase::kSearch || phase() == GuidancePhase::kApproach;
  if (is_high && input.box && !IsInFence(*input.box)) {
    return "the box is outside of the geofence: gave up";
  }
  if (phase() != GuidancePhase::kApproach || !input.target || carries_) return nullptr;
  const Vector2d object = input.target->motion.position().head<2>();
  if (IsInFence(object)) {
    const bool is_in_box = input.box && GoDelivery::IsIn(*input.box, object);
    if (is_in_box) Leave(false, "the object is in the box: goes on to the next one");
    return nullptr;
  }
  if (!job_.delivers) return "the object is outside of the geofence: gave up";
  Leave(false, "the object is outside of the geofence: goes on to the next one");
  return nullptr;
}

// Whatever the height.
bool GoGuidance::IsInFence(const Vector2d& place) const {
  return limits().Contains({place.x(), place.y(), options().limits.floor_m});
}

Guidance::Wish GoGuidance::Choose(const GuidanceInput& input) {
  // A gripper may rest on the object: the climb takes the UAV off again.
  if (input.is_landed && !AwaitsPerson() && !IsLow() && phase() != GuidancePhase::kGoAround) {
    End("the UAV is on the ground");
    return {};
  }
  if (job_.target == GoTarget::kMarked) TakeOrder(input);
  if (HasJumped(input)) Await("was seen again where it cannot be: needs a new confirmation");
  if (AwaitsPerson()) {
    Wish wish;
    wish.set_point = Wait(Look(input));
    wish.set_point.yaw = yaw_;
    return wish;
  }
  // The vision has not heard yet that the job at this object has ended.
  const bool has_ended = ended_.mark != 0 && input.mark == ended_.mark && !carries_;
  // Near the object the view of another one is that of none; but what is seen below may have got
  // another number.
  const bool is_elsewhere = phase() != GuidancePhase::kLook || Look(input).off_m > kBelow_m;
  const bool is_another = input.mark != mark_ && is_elsewhere &&
                          phase() != GuidancePhase::kSearch &&
                          phase() != GuidancePhase::kApproach && !carries_;
  // The track of an object that was taken may go on with another one near by.
  const bool is_foreign = phase() == GuidancePhase::kLook && has_gripped_ && !IsWhereGripped(input);
  if (input.target && (is_another || has_ended || is_foreign)) {
    GuidanceInput without = input;
    without.target.reset();
    return Choose(without);
  }
  const Situation now = Look(input);
  travel_m_ = std::min(options().search_altitude_m + kLayer_m * input.layer,
                       options().limits.ceiling_m - options().leg_m);
  ChoosePhase(input, now);
  Wish wish;
  // Gusts are met at the object only: on the way drag looks like one, and on the ground the load on
  // the legs does.
  if (!IsLow() || Rests(input.now)) flight_model().Rest();
  // Above a place the height of the job is floor enough: it counts from the ground there.
  wish.follows_target = input.target.has_value() && !carries_;
  if (input.gripper.number == answers_before_) wish.request = motion_;
  wish.set_point = Command(input, now);
  wish.set_point.yaw = yaw_;
  KeepAway(input, now, &wish.set_point);
  wish.is_flying = !Rests(input.now);
  return wish;
}

// Near the ground, at work or after it, and where the gripper moves, there is no way to the sides.
void GoGuidance::KeepAway(const GuidanceInput& input, const Situation& now, SetPoint* command) {
  const bool is_near_ground =
      (is_at_work() || is_done_) && input.target && now.height_m < options().sight_height_m;
  const bool uses_gripper = phase() == GuidancePhase::kAct && job_.grips();
  if (is_near_ground || uses_gripper) return;
  const Vector2d fed = flight_model().fed_velocity();
  const Vector2d own = command->velocity.head<2>() - fed;
  command->velocity.head<2>() = own;
  KeepApart({now.feet.head<2>(), now.velocity.head<2>(), is_at_work()}, going_to_, input.others,
            command);
  // Beside another UAV gusts are not met: their path would go on towards it.
  if (command->velocity.head<2>() != own) return flight_model().Rest();
  command->velocity.head<2>() += fed;
}

void GoGuidance::ChoosePhase(const GuidanceInput& input, const Situation& now) {
  if (is_done_) return;
  if (carries_) return Deliver(input, now);
  if (input.target && !has_gripped_) KeepPlace(input, now);
  if (MustClimbOff(input, now)) {
    waits_since_.reset();
    return Enter(GuidancePhase::kGoAround, "gives way to another UAV of the team");
  }
  if (phase() == GuidancePhase::kAct) return Act(input);
  if (phase() == GuidancePhase::kGoAround) return ChooseClimb(input, now);
  if (phase() == GuidancePhase::kLook) return LookWhetherGone(input, now);
  if (!FindObject(input)) return;
  if (phase() == GuidancePhase::kApproach) ChooseApproach(input, now);
  if (phase() == GuidancePhase::kDescend) ChooseDescent(input, now);
  if (phase() == GuidancePhase::kCommit) ChooseCommit(input, now);
}

// False when there is none.
bool GoGuidance::FindObject(const GuidanceInput& input) {
  if (!input.target) {
    if (IsLow()) {
      TryAgain("the object is lost");
    } else if (phase() != GuidancePhase::kSearch) {
      Lose(input.now);
    }
    return false;
  }
  object_z_m_ = input.target->motion.position().z();
  if (phase() == GuidancePhase::kSearch || input.mark != mark_) {
    if (job_.delivers && input.mark != mark_) failures_ = 0;
    mark_ = input.mark;
    pursuit().Reset();
    Enter(GuidancePhase::kApproach, "flies to the goal");
  }
  return true;
}

// An object that only others have seen may not be there any more.
void GoGuidance::ChooseApproach(const GuidanceInput& input, const Situation& now) {
  const bool is_above = now.off_m < kConePart * Cone(now.height_m);
  Remember(is_above && input.is_camera_up && !now.is_in_sight, input.now, &waits_since_);
  if (!is_above) return;
  if (ComesNear(now, input.others, kGiveWay_m)) {
    set_reason("waits above the object: another UAV of the team is near");
  } else if (MayDescend(now)) {
    waits_since_.reset();
    Enter(GuidancePhase::kDescend, job_.target == GoTarget::kPlace
                                       ? "above the place"
                                       : "above the object, which is in sight");
  } else if (!IsLongerThan(kUnseen_s, waits_since_, input.now)) {
    set_reason("waits above the object: it is not in sight, or not known well enough");
  } else if (job_.target == GoTarget::kMarked) {
    Lose(input.now);
  } else {
    Leave(false, "the object is not seen from above: goes on to the next one");
  }
}

void GoGuidance::ChooseDescent(const GuidanceInput& input, const Situation& now) {
  const double cone_m = Cone(now.height_m);
  const bool is_near_ground = now.height_m < options().sight_height_m;
  if (input.target->position_sigma_m() > kLostSigmas * options().max_sigma_m) {
    return TryAgain("the object's place is not known well enough");
  }
  if (!now.is_in_sight && now.feet.z() > travel_m_ - kFarView_m) {
    return Enter(GuidancePhase::kApproach, "not in sight: waits above it");
  }
  if (now.off_m > 2 * cone_m) {
    if (is_near_ground) return TryAgain("too far beside the goal");
    return Enter(GuidancePhase::kApproach, "too far beside the goal");
  }
  const double wait_m = job_.height_m + kWait_m;
  if (is_near_ground && now.height_m > wait_m - kReach_m && !IsSureOf(input)) {
    return TryAgain("low, and the object is not in sight");
  }
  if (job_.action == GoAction::kPick && !is_open_) {
    is_open_ = Operate(input, GuidanceRequest::kRelease);
    if (fault_ != nullptr) give_up_ = fault_;
    if (!is_open_) return;
  }
  if (now.height_m > wait_m + kReach_m) {
    waits_since_.reset();
    return;
  }
  Remember(true, input.now, &waits_since_);
  if (now.is_in_sight && IsAbove(now)) {
    rests_since_.reset();
    Enter(GuidancePhase::kCommit, "near the goal, and above it");
  } else if (IsLongerThan(kAimWait_s, waits_since_, input.now)) {
    TryAgain("does not come to above the goal");
  }
}

// A gripper must be nearer than a view from above; at a place, which is not known to centimetres,
// only until that has failed once.
bool GoGuidance::IsAbove(const Situation& now) const {
  const bool is_precise = job_.is_exact() || (job_.grips() && failures_ == 0);
  if (!is_precise) return now.off_m < kConePart * Cone(now.height_m);
  return now.off_m < kAim_m && now.slip_mps < kAim_mps;
}

void GoGuidance::ChooseCommit(const GuidanceInput& input, const Situation& now) {
  if (!IsSureOf(input)) {
    return Enter(GuidancePhase::kDescend, "near the object, and not in sight: looks from higher");
  }
  if (now.off_m > kCommitCones * Cone(now.height_m)) return TryAgain("beside the goal");
  if (HasReached(input, now)) {
    gripped_.reset();
    at_grip_.reset();
    return Enter(GuidancePhase::kAct, job_.grips() ? "uses the gripper" : "hovers above the goal");
  }
  if (ToSeconds(input.now - entered()) > kAimWait_s) TryAgain("does not come to the goal");
}

bool GoGuidance::HasReached(const GuidanceInput& input, const Situation& now) {
  const bool rests = now.velocity.z() - input.target->motion.velocity().z() > -kStandstill_mps;
  Remember(rests && now.height_m > job_.height_m + kReach_m, input.now, &rests_since_);
  const bool rests_on_it = is_at_deck() && IsLongerThan(kRests_s, rests_since_, input.now);
  const bool is_down = now.height_m <= job_.height_m + kReach_m || rests_on_it;
  return is_down && (job_.is_exact() ? MayGrip(*input.target, now) : IsAbove(now));
}

// The gripper must be there when it closes, a moment later.
bool GoGuidance::MayGrip(const TargetEstimate& target, const Situation& now) const {
  const Vector2d off = (now.feet - target.motion.position()).head<2>();
  const Vector2d slip = (now.velocity - target.motion.velocity()).head<2>();
  const double later_m = (off + kGripDelay_s * slip).norm();
  return std::max(off.norm(), later_m) < kGrip_m && slip.norm() < kAim_mps &&
         target.position_sigma_m() < kGripSigma_m;
}

void GoGuidance::Act(const GuidanceInput& input) {
  if (job_.grips()) return Grip(input);
  if (!input.target || !IsSureOf(input)) {
    return TryAgain("the object is not in sight any more");
  }
  if (ToSeconds(input.now - entered()) >= job_.seconds) Finish();
}

void GoGuidance::Grip(const GuidanceInput& input) {
  const bool picks = job_.action == GoAction::kPick;
  if (!gripped_) {
    if (picks) is_open_ = false;
    RememberGrip(input);
    if (Operate(input, picks ? GuidanceRequest::kGrab : GuidanceRequest::kRelease)) {
      gripped_ = input.now;
    }
    if (fault_ != nullptr) Enter(GuidancePhase::kGoAround, "the autopilot refuses the gripper");
    return;
  }
  if (!IsLongerThan(job_.seconds, gripped_, input.now)) return;
  has_gripped_ = true;
  set_place(Look(input).feet.head<2>());
  Enter(GuidancePhase::kGoAround, "climbs with the gripper used");
}

void GoGuidance::ChooseClimb(const GuidanceInput& input, const Situation& now) {
  const double highest_m = options().search_altitude_m - object_z_m_ - kReach_m;
  if (now.feet.z() - object_z_m_ < std::min(options().sight_height_m, highest_m)) return;
  if (fault_ != nullptr) {
    give_up_ = fault_;
  } else if (skips_) {
    Leave(false, "does not come down on the object: goes on to the next one");
  } else if (has_gripped_ && job_.action == GoAction::kPick) {
    unseen_s_ = 0;
    Enter(GuidancePhase::kLook, "looks whether the object is gone");
  } else if (has_gripped_) {
    Finish();
  } else if (input.target) {
    Enter(GuidancePhase::kApproach, "high enough to come again");
  } else {
    Lose(input.now);
  }
}

void GoGuidance::RememberGrip(const GuidanceInput& input) {
  if (input.target) at_grip_ = Gripped{input.target->motion, input.now};
}

// True when the target is the object that the gripper closed on, had it missed.
bool GoGuidance::IsWhereGripped(const GuidanceInput& input) const {
  if (!input.target || !at_grip_) return input.target.has_value();
  const bool moves = at_grip_->motion.velocity().norm() > kStands_mps;
  const double since_s = moves ? ToSeconds(input.now - at_grip_->time) : 0;
  const Vector3d there = at_grip_->motion.position() + since_s * at_grip_->motion.velocity();
  const double stray_m = std::min(kSame_m + kStrays_mps * since_s, kMostStray_m);
  return (input.target->motion.position() - there).head<2>().norm() < stray_m;
}

// Images without the object count only while they come, and show where it was.
void GoGuidance::LookWhetherGone(const GuidanceInput& input, const Situation& now) {
  const double looked_s = ToSeconds(input.now - entered());
  const double seen_s = input.target_age_s + GuidanceInput::kMostVideoDelay_s;
  if (input.target && seen_s < looked_s) return TryAgain("the object is still there");
  const bool is_above = (now.feet.head<2>() - place()).norm() < kBelow_m;
  if (input.is_camera_up && is_above) unseen_s_ += SecondsSinceLast(input.now);
  if (unseen_s_ >= kGone_s) Finish();
}

void GoGuidance::TryAgain(const char* reason) {
  waits_since_.reset();
  ++failures_;
  skips_ = job_.delivers && failures_ >= kTries;
  if (!job_.delivers && failures_ >= kTries) {
    fault_ = has_gripped_ ? "the object is still there after all tries: gave up"
                          : "does not come down on the goal: gave up";
  }
  has_gripped_ = false;
  Enter(GuidancePhase::kGoAround, reason);
}

void GoGuidance::Finish() {
  if (job_.delivers) {
    ended_ = {mark_, true};
    carries_ = true;
    is_near_box_ = false;
    return Enter(GuidancePhase::kApproach, "carries the object to the box");
  }
  if (job_.action == GoAction::kPick) ended_ = {mark_, true};
  is_done_ = true;
  Enter(GuidancePhase::kLook, InWords(job_.action));
}

void GoGuidance::Lose(Time now) {
  if (job_.target == GoTarget::kMarked) {
    return Await("what is marked is lost: needs a new confirmation");
  }
  if (!job_.delivers) return SearchAfterLoss(now);
  Leave(false, "the object is lost: goes on to the next one");
  ended_.mark = 0;  // it may be found again
}

// Goes on to the next object, which it awaits where it began.
void GoGuidance::Leave(bool is_taken, const char* reason) {
  if (!is_taken) ended_ = {mark_, false};
  mark_ = failures_ = 0;
  carries_ = skips_ = has_gripped_ = is_open_ = false;
  set_place(home_);
  StartSearch();
  set_reason(reason);
}

// Others use the box, too: the UAV comes to it when they are away.
void GoGuidance::Deliver(const GuidanceInput& input, const Situation& now) {
  if (phase() == GuidancePhase::kAct) {
    if (!gripped_ && Operate(input, GuidanceRequest::kRelease)) gripped_ = input.now;
    if (fault_ != nullptr) give_up_ = fault_;
    if (!IsLongerThan(job_.seconds, gripped_, input.now)) return;
    return Leave(true, "the object is in the box: goes on to the next one");
  }
  if (!input.box) return set_reason("carries the object; the place of the box is not known yet");
  if (!delivery_.MayOpen(*input.box, now.feet, now.velocity)) return;
  gripped_.reset();
  Enter(GuidancePhase::kAct, "opens the gripper above the box");
}

bool GoGuidance::is_at_work() const {
  if (carries_) return phase() == GuidancePhase::kAct || is_near_box_;
  return IsLow() || phase() == GuidancePhase::kGoAround ||
         (phase() == GuidancePhase::kLook && !is_done_);
}

bool GoGuidance::is_at_deck() const {
  return (phase() == GuidancePhase::kCommit || phase() == GuidancePhase::kAct) && !carries_ &&
         job_.height_m < options().commit_height_m;
}

// Once the gripper moves the UAV does not leave the object.
bool GoGuidance::MustClimbOff(const GuidanceInput& input, const Situation& now) const {
  if (!IsLow() || (phase() == GuidancePhase::kAct && job_.grips())) return false;
  return ComesNear(now, input.others, kClimbOff_m);
}

// Above objects that move two UAVs come to each other faster than a climb lasts: true when one that
// goes first is within the distance, or will be.
bool GoGuidance::ComesNear(const Situation& now, std::span<const OtherUav> others,
                           double distance_m) {
  return std::ranges::any_of(others, [&](const OtherUav& other) {
    const Vector2d way = other.position - now.feet.head<2>();
    const Vector2d later = way + kClimbOff_s * (other.velocity - now.velocity.head<2>());
    return other.goes_first && std::min(way.norm(), later.norm()) < distance_m;
  });
}

bool GoGuidance::Rests(Time now) const {
  return is_at_deck() && IsLongerThan(kTouches_s, rests_since_, now);
}

bool GoGuidance::IsLow() const {
  return phase() == GuidancePhase::kDescend || phase() == GuidancePhase::kCommit ||
         (phase() == GuidancePhase::kAct && !carries_);
}

bool GoGuidance::Operate(const GuidanceInput& input, GuidanceRequest motion) {
  if (motion_ != motion) {
    motion_ = motion;
    answers_before_ = input.gripper.number;
    return false;
  }
  if (input.gripper.number == answers_before_) return false;
  motion_ = GuidanceRequest::kNone;
  if (!input.gripper.is_accepted) fault_ = "the autopilot does not operate the gripper: gave up";
  return input.gripper.is_accepted;
}

SetPoint GoGuidance::Command(const GuidanceInput& input, const Situation& now) {
  going_to_ = place();
  if (carries_) return Carry(input, now);
  if (phase() == GuidancePhase::kSearch) {
    SetPoint command = Search(input, now);
    command.velocity.z() = ClimbRate(now);
    return command;
  }
  // From the grip until it has looked it stays there: a track that goes on without the object leads
  // it to others.
  if (input.target && !is_done_ && !has_gripped_) return Pursue(input, now);
  return Stay(place(), travel_m_, now);
}

SetPoint GoGuidance::Pursue(const GuidanceInput& input, const Situation& now) {
  SetPoint command = pursuit().Above(
      *input.target, {now.feet.head<2>(), now.velocity.head<2>(), now.height_m}, &flight_model());
  double climb = ClimbRate(now);
  if (phase() == GuidancePhase::kDescend) {
    climb = std::max(climb, -stale().MaxSink(now.height_m, input.link_delay_s));
    if (!now.is_known) climb = std::max(climb, 0.0);
    const double rise = kHeightGain * (travel_m_ - now.feet.z());
    if (!now.is_in_sight) climb = std::max(climb, std::clamp(rise, 0.0, kRise_mps));
  }
  command.velocity.z() = climb;
  return command;
}

SetPoint GoGuidance::Wait(const Situation& now) {
  if (!waits_at_ && now.velocity.norm() < kHalted_mps) waits_at_ = now.feet;
  if (!waits_at_) return {};
  const double lowest_m = options().limits.floor_m - options().leg_m;
  return Stay(waits_at_->head<2>(), std::max(waits_at_->z(), lowest_m), now);
}

SetPoint GoGuidance::Stay(const Vector2d& place, double height_m, const Situation& now) {
  SetPoint command = pursuit().To(place, {now.feet.head<2>(), now.velocity.head<2>()},
                                  &flight_model(), options().limits.max_speed_mps);
  command.velocity.z() = kHeightGain * (height_m - now.feet.z());
  return command;
}

// Up again where another UAV goes first.
SetPoint GoGuidance::Carry(const GuidanceInput& input, const Situation& now) {
  if (!input.box) return Stay(place(), travel_m_, now);
  going_to_ = *input.box;
  is_near_box_ = GoDelivery::IsNear(going_to_, now.feet);
  const bool gives_way =
      phase() != GuidancePhase::kAct && MustGiveWay(now.feet.head<2>(), input.others, kClimbOff_m);
  const auto [place, height_m] = delivery_.Choose(going_to_, now.feet, travel_m_, gives_way);
  return Stay(place, height_m, now);
}

double GoGuidance::ClimbRate(const Situation& now) const {
  if (!IsLow()) return kHeightGain * (travel_m_ - now.feet.z());
  const double left_m = now.height_m - job_.height_m;
  if (phase() == GuidancePhase::kAct) return rests_since_ ? 0 : -kLastGain * left_m;
  if (phase() == GuidancePhase::kCommit) {
    const double sink = std::max(GuidanceOptions::kSinkGain * left_m, kLastSink_mps);
    return -std::min(sink, kLastGain * left_m);
  }
  // Beside the object it rises, to see it, but does not sink.
  const double climb = -GuidanceOptions::kSinkGain * (left_m - kWait_m);
  return now.off_m >= kConePart * Cone(now.height_m) ? std::max(climb, 0.0) : climb;
}

}  // namespace kestrel
