// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/landing_guidance.h"

#include <algorithm>
#include <cmath>

#include "kestrel/core/geometry/angles.h"
#include "kestrel/flight/guidance/since.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kResting_mps =
    0.25;  // a UAV that sinks more slowly than this on command to descend rests
constexpr double kCommandedDown_mps = 0.3;
constexpr double kFollowCones = 4;           // offset, in cones, at which following ends
constexpr double kCommitAcceleration = 0.2;  // m/s^2, downwards

}  // namespace

LandingGuidance::LandingGuidance(const GuidanceOptions& options,
                                 const std::optional<Vector2d>& place)
    : DescentGuidance(options, place),
      contact_(options.contact),
      stay_(options),
      heading_(options) {}

void LandingGuidance::Begin(const GuidanceInput& input) {
  heading_.Start(LevelHeadingOf(input.uav->world_from_body.rotation));
  go_arounds_ = 0;
  contact_.Reset();
  contact_since_.reset();
  timing_.Reset();
  StartSearch();
}

void LandingGuidance::ResumeAfterLink() {
  if (IsLow() || phase() == GuidancePhase::kFollow) GoAround("the link was gone");
}

void LandingGuidance::ResumeAfterPoses() {
  if (IsLow()) GoAround("the poses had stopped");
}

const char* LandingGuidance::WhyGiveUp(const GuidanceInput& input) {
  const bool waits_for_heading =
      phase() == GuidancePhase::kFollow || phase() == GuidancePhase::kDescend;
  if (heading_.IsOverdue(input.now, waits_for_heading)) {
    return heading_.is_known() ? "the nose does not come to the heading over the pad: gave up"
                               : "the pad's heading is not known: gave up";
  }
  if (phase() == GuidancePhase::kSearch && IsSearchOver(input.now)) {
    return "the target was not found again: gave up";
  }
  return nullptr;
}

Guidance::Wish LandingGuidance::Choose(const GuidanceInput& input) {
  if (input.deck) {
    timing_.Observe(input.deck->time, input.deck->height_m, input.deck->normal);
  }
  heading_.Update(input.now, LevelHeadingOf(input.uav->world_from_body.rotation), input.target,
                  input.link_delay_s);
  const Situation now = Look(input);
  ChoosePhase(input, now);
  Wish wish;
  if (!is_active()) return wish;
  wish.is_flying = phase() != GuidancePhase::kLanded;
  wish.follows_target = input.target.has_value() || !wish.is_flying;
  if (wish.is_flying) {
    wish.set_point = input.target ? Pursue(input, now) : Search(input, now);
  } else {
    wish.set_point =
        stay_.Rest(input.now, input.uav->world_from_body.rotation, now.velocity, model().delay_s());
    wish.request = stay_.Request(input.now, input.is_landed, contact_since_);
  }
  if (!wish.set_point.yaw) {
    wish.set_point.yaw = heading_.yaw();
    if (heading_.is_known()) wish.set_point.yaw_rate = heading_.yaw_rate();
  }
  return wish;
}

void LandingGuidance::ChoosePhase(const GuidanceInput& input, const Situation& now) {
  if (FindContact(input, now)) return;
  if (!input.target) {
    if (IsLow()) ++go_arounds_;
    if (phase() != GuidancePhase::kSearch) SearchAfterLoss(input.now);
    return;
  }
  KeepPlace(input, now);
  if (phase() == GuidancePhase::kSearch) Enter(GuidancePhase::kApproach, "the target is found");
  if (phase() == GuidancePhase::kGoAround && now.height_m >= options().sight_height_m) {
    Enter(GuidancePhase::kApproach, "high enough to come again");
  }
  ChooseAbove(now);
  ChooseDescent(input, now);
}

// Chooses between approach, follow and the beginning of the descent.
void LandingGuidance::ChooseAbove(const Situation& now) {
  const double cone_m = Cone(now.height_m);
  if (phase() == GuidancePhase::kApproach && now.off_m < cone_m && now.slip_mps < kMaxClosing_mps) {
    Enter(GuidancePhase::kFollow, "above the target");
  }
  if (phase() != GuidancePhase::kFollow) return;
  if (now.off_m > kFollowCones * cone_m) {
    Enter(GuidancePhase::kApproach, "too far from the target");
  } else if (now.off_m < cone_m && MayDescend(now)) {
    if (heading_.is_wanted() && !heading_.is_known()) {
      set_reason("waits above the target: the pad's heading is not known");
    } else {
      Enter(GuidancePhase::kDescend, "above the target, which is in sight");
    }
  }
}

// Chooses within the descent: on down to the deck, or up again.
void LandingGuidance::ChooseDescent(const GuidanceInput& input, const Situation& now) {
  const double cone_m = Cone(now.height_m);
  if (phase() == GuidancePhase::kDescend) {
    if (!now.is_known) return GoAround("the target is not known well enough");
    if (!now.is_credible) return GoAround("the target rises or sinks: not a deck");
    if (now.off_m > 2 * cone_m) {
      if (now.height_m < options().sight_height_m) return GoAround("too far beside the target");
      return Enter(GuidancePhase::kApproach, "too far beside the target");
    }
    if (!now.is_in_sight && now.height_m < options().sight_height_m) {
      return GoAround("low, and the target is not in sight");
    }
    if (now.height_m < options().commit_height_m && now.off_m < cone_m && heading_.is_reached()) {
      Enter(GuidancePhase::kCommit, "near the deck, within the cone");
    }
  }
  if (phase() != GuidancePhase::kCommit) return;
  // A UAV that does not sink any more stands on the deck, where the camera may see nothing.
  const bool sinks = now.velocity.z() - input.target->motion.velocity().z() < -kResting_mps;
  if (sinks && !(input.target_age_s <= GuidanceOptions::kCommitSight_s)) {
    return GoAround("near the deck, and the target was not in sight for too long");
  }
  if (now.is_in_sight && now.off_m > kCommitCones * cone_m) GoAround("beside the deck");
  if (now.height_m > 2 * options().commit_height_m) GoAround("has risen from the deck");
}

// True when the UAV stands on the deck: by its rest against the deck, or because the autopilot
// reports it.
bool LandingGuidance::FindContact(const GuidanceInput& input, const Situation& now) {
  // A UAV without a command to descend may hover near the deck.
  const bool is_commanded_down = sent() && sent()->velocity.z() < -kCommandedDown_mps;
  std::optional<ContactDetector::Deck> deck;
  if (input.target && is_commanded_down) {
    deck = ContactDetector::Deck{input.target->motion.position(), input.target->motion.velocity()};
  }
  const bool was_in_contact = phase() == GuidancePhase::kLanded;
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

SetPoint LandingGuidance::Pursue(const GuidanceInput& input, const Situation& now) {
  SetPoint command =
      pursuit().Above(*input.target, {now.feet.head<2>(), now.velocity.head<2>()}, &flight_model());
  command.velocity.z() = ClimbRate(input, now);
  if (phase() != GuidancePhase::kCommit) {
    const double most = stale().MaxSink(now.height_m, input.link_delay_s);
    command.velocity.z() = std::max(command.velocity.z(), -most);
  }
  command.velocity.z() += timing_.Climb(input.now, model().delay_s());
  // Out of sight only the last bit goes down. Near the deck the descent stops early, because a UAV
  // takes a while to stop; it goes around when that has lasted.
  const double patience_s =
      now.height_m < options().sight_height_m ? 0.5 * options().sight_s : options().sight_s;
  const bool is_seen = now.is_in_sight && input.target_age_s <= patience_s;
  if (!is_seen && phase() != GuidancePhase::kCommit) {
    command.velocity.z() = std::max(command.velocity.z(), 0.0);
  }
  return command;
}

double LandingGuidance::ClimbRate(const GuidanceInput& input, const Situation& now) {
  const double sink =
      std::max(GuidanceOptions::kSinkGain * now.height_m, options().touchdown_sink_mps);
  if (phase() == GuidancePhase::kCommit) {
    // Ever faster: the autopilot then does not mistake the stop by the deck for its own braking.
    return -sink - kCommitAcceleration * ToSeconds(input.now - entered());
  }
  if (phase() == GuidancePhase::kDescend) {
    if (now.off_m >= Cone(now.height_m)) return 0;
    const auto wait_m = WaitHeight(input.now, now.height_m);
    return wait_m ? std::max(-sink, kHeightGain * (*wait_m - now.height_m)) : -sink;
  }
  const double top_m = options().search_altitude_m - input.target->motion.position().z();
  const bool is_unknown = input.target->position_sigma_m() > 2 * options().max_sigma_m;
  const double wanted_m =
      is_unknown ? top_m : std::max(options().follow_height_m, GuidanceOptions::kGlide * now.off_m);
  return kHeightGain * (std::min(wanted_m, top_m) - now.height_m);
}

// Height below which the UAV does not go yet: before the deck is level, or without the heading.
std::optional<double> LandingGuidance::WaitHeight(Time now, double height_m) {
  const bool waits_for_deck = timing_.Waits(now, height_m);
  if (!heading_.is_reached()) {
    return std::max(TouchdownTiming::kWaitHeight_m, 2 * options().commit_height_m);
  }
  return waits_for_deck ? std::optional(TouchdownTiming::kWaitHeight_m) : std::nullopt;
}

void LandingGuidance::GoAround(const char* reason) {
  ++go_arounds_;
  timing_.Reset();
  Enter(GuidancePhase::kGoAround, reason);
}

bool LandingGuidance::IsLow() const {
  return phase() == GuidancePhase::kDescend || phase() == GuidancePhase::kCommit;
}

}  // namespace kestrel
