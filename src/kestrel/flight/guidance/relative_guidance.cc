// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/relative_guidance.h"

#include <algorithm>
#include <cmath>

#include "kestrel/core/base/options.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/core/poses/gravity.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using State = RelativePadState;

constexpr double kOldestMode_s = 3.5;      // after so long without a report the mode is not known
constexpr double kAttitudeDelay_s = 0.15;  // from a commanded lean to the lean
constexpr double kFastest_mps = 0.8;       // towards the pad
constexpr double kJerk = 8;                // m/s^3, of the commanded acceleration
constexpr double kMostVertical = 3;        // m/s^2, commanded
constexpr double kStepLimit_s = 0.2;
constexpr double kStill_mps = 0.25;
// Standard deviation of a velocity that is followed, and of a climb that is controlled.
constexpr double kKnown_mps = 0.45, kKnownClimb_mps = 0.4;
// Height control, 1/s each.
constexpr double kHeightGain = 1.2, kClimbGain = 2.5;
constexpr double kClimb_mps = 1, kWiden_mps = 0.5;
// Ages of the pad in the ladder of losses, and the way that it may take.
constexpr double kLost_s = 0.3, kWiden_s = 1.5, kFirstEnd_s = 3, kLastEnd_s = 5;
constexpr double kLargestDrift_m = 1.5;  // two standard deviations
// The descent without the pad, and where the autopilot's own landing takes over.
constexpr double kBlindSink_mps = 0.6, kLandBelow_m = 0.25, kAtRest_mps = 0.2;
// The last bit of a landing.
constexpr double kContact_m = 0.05, kCommitUnseen_s = 1, kLongestCommit_s = 3;
constexpr double kPilotPatience_s = 1.5;  // until LAND is requested instead of his mode

constexpr char kTurns[] = "turns to the heading over the pad";

Vector2d Limited(const Vector2d& vector, double most) {
  const double size = vector.norm();
  return size > most ? Vector2d(most / size * vector) : vector;
}

// The way of the feet, level, m: the UAV leans against the wind, and its feet are not below it.
Vector2d WayOfFeet(const RelativePadState::Estimate& pad, double leg_m) {
  return pad.way().head<2>() - leg_m / kGravity * pad.bias().head<2>();
}

}  // namespace

RelativeGuidance::RelativeGuidance(const GuidanceOptions& options, const RelativeJob& job,
                                   bool streams)
    : options_(Checked(options)),
      job_(job),
      heading_(options_),
      streams_(streams),
      may_stream_(streams),
      reason_("waits for the pilot to give the mode") {}

// A double integrator with this delay stays well damped at any height: the way is in metres.
RelativeGuidance::Gains RelativeGuidance::GainsFor(double delay_s) {
  constexpr double kMost = 2.2, kDamping = 0.9;
  const double velocity = std::min(kMost, 0.4 / delay_s);
  const double half = velocity / (2 * kDamping);
  return {half * half, velocity};
}

RelativeOutput RelativeGuidance::Update(const RelativeInput& input) {
  RelativeOutput output;
  if (HasLink(input)) {
    FollowMode(input);
    if (is_active_ && !(input.pad && input.has_attitude)) {
      GiveUp(input, "the attitude is not sent: lands where it is");
    }
    if (is_active_) WatchHeading(input);
    if (is_active_) ChoosePhase(input);
    if (is_active_) {
      output.set_point = Fly(input);
      if (phase_ == GuidancePhase::kLanded) output.request = GuidanceRequest::kLand;
    } else if (has_given_up_) {
      output.request = RequestEnd(input);
    } else if (may_stream_ && !input.is_guided) {
      output.set_point = RelativeSetPoint{};
    }
  }
  sent_.reset();
  if (output.set_point && is_active_) sent_ = output.set_point->acceleration.head<2>();
  last_ = input.now;
  output.phase = phase_;
  output.reason = reason_;
  return output;
}

// The pilot may have left the mode while there was no link: its next report decides.
bool RelativeGuidance::HasLink(const RelativeInput& input) {
  if (!input.is_link_up || input.mode_age_s > kOldestMode_s) {
    mode_wanted_since_ = input.now;
    return false;
  }
  if (!mode_wanted_since_) return true;
  if (input.mode_age_s > ToSeconds(input.now - *mode_wanted_since_)) return false;
  mode_wanted_since_.reset();
  return true;
}

void RelativeGuidance::FollowMode(const RelativeInput& input) {
  const bool was_guided = was_guided_.value_or(input.is_guided);
  was_guided_ = input.is_guided;
  if (input.is_guided && !was_guided) Start(input);
  if (input.is_guided || !was_guided) return;
  const char* const left = streams_ ? "the mode was left: disarm before it is given again"
                                    : "the mode was left: give it anew to begin again";
  End(phase_ == GuidancePhase::kLanded ? "landed; guidance has ended" : left);
  has_given_up_ = false;
}

bool RelativeGuidance::CanBegin(const RelativeInput& input) {
  return input.pad && input.has_attitude && input.pad_age_s < kLost_s &&
         input.pad->Sigma(State::kVelocity) <= kKnown_mps;
}

void RelativeGuidance::Start(const RelativeInput& input) {
  may_stream_ = false;
  if (!input.is_armed || input.is_landed) return End("refused: the UAV is on the ground");
  if (!input.is_allowed) return GiveUp(input, "refused: ends the mode");
  if (!CanBegin(input)) {
    return GiveUp(input, "refused: the pad is not in view, or not for long enough");
  }
  is_active_ = true;
  last_ = input.now;
  height_m_ = -input.pad->way().z();
  heading_.Start(input.nose);
  ignores_heading_ = false;
  Enter(GuidancePhase::kApproach, "flies to above the pad", input.now);
}

void RelativeGuidance::End(const char* reason) {
  is_active_ = false;
  if (phase_ != GuidancePhase::kLanded) phase_ = GuidancePhase::kIdle;
  reason_ = reason;
}

void RelativeGuidance::GiveUp(const RelativeInput& input, const char* reason) {
  has_given_up_ = true;
  gave_up_ = input.now;
  phase_ = GuidancePhase::kIdle;
  End(reason);
}

void RelativeGuidance::Enter(GuidancePhase phase, const char* reason, Time now) {
  phase_ = phase;
  reason_ = reason;
  entered_ = now;
}

// A mode that the autopilot refuses the pilot is given up for a landing.
GuidanceRequest RelativeGuidance::RequestEnd(const RelativeInput& input) const {
  if (!input.is_armed || input.is_landed) return GuidanceRequest::kNone;
  const bool is_for_pilot = input.has_pilot && ToSeconds(input.now - gave_up_) < kPilotPatience_s;
  return is_for_pilot ? GuidanceRequest::kAltitude : GuidanceRequest::kLand;
}

void RelativeGuidance::ChoosePhase(const RelativeInput& input) {
  if (phase_ == GuidancePhase::kLanded) return;
  if (!input.is_armed) return End("the motors are off");
  if (phase_ == GuidancePhase::kCommit) return Commit(input);
  if (input.is_landed) return Enter(GuidancePhase::kLanded, "the autopilot has landed", input.now);
  if (phase_ == GuidancePhase::kSearch) return FollowLoss(input);
  if (input.pad_age_s > kLost_s) return Lose(input);
  const double feet_m = FeetHeight(input);
  if (phase_ == GuidancePhase::kApproach && IsAbove(input, Cone(feet_m), kStill_mps)) {
    return Enter(GuidancePhase::kFollow, job_.lands ? "above the pad" : "hovers above the pad",
                 input.now);
  }
  if (phase_ == GuidancePhase::kFollow && job_.lands) return Wait(input);
  if (phase_ == GuidancePhase::kDescend) Descend(input);
}

// Above the pad, until the UAV is still and its nose is right.
void RelativeGuidance::Wait(const RelativeInput& input) {
  constexpr double kSettle_s = 1;
  if (!IsAbove(input, Cone(FeetHeight(input)), kStill_mps)) entered_ = input.now;
  if (ToSeconds(input.now - entered_) < kSettle_s) return;
  if (heading_.is_reached() || ignores_heading_) {
    return Enter(GuidancePhase::kDescend, "", input.now);
  }
  reason_ = heading_.is_known() ? kTurns : "waits above the pad: its heading is not known";
}

// To give up for a heading would be a landing beside the pad.
void RelativeGuidance::WatchHeading(const RelativeInput& input) {
  heading_.Update(input.now, input.nose, input.pad_heading, input.link_delay_s);
  const bool waits =
      phase_ == GuidancePhase::kFollow || (phase_ == GuidancePhase::kDescend && HasToTurn());
  if (heading_.IsOverdue(input.now, waits && job_.lands)) ignores_heading_ = true;
}

// In the descent the pad may show that its heading is another one.
bool RelativeGuidance::HasToTurn() const {
  constexpr double kFar = Radians(10);
  return !ignores_heading_ && !heading_.is_reached() &&
         std::abs(heading_.error().value_or(0)) > kFar;
}

// The time that it may fly without the pad follows from how well velocity and bias are known.
void RelativeGuidance::Lose(const RelativeInput& input) {
  lost_after_s_ = kFirstEnd_s;
  const RelativePadState::Estimate& pad = *input.pad;
  while (lost_after_s_ < kLastEnd_s && 2 * pad.DriftSigma(lost_after_s_) < kLargestDrift_m) {
    lost_after_s_ += 0.25;
  }
  sunk_m_ = 0;
  low_since_.reset();
  lost_height_m_ = -pad.way().z();
  Enter(GuidancePhase::kSearch, "the pad is lost: level, against the wind as it was", input.now);
}

void RelativeGuidance::FollowLoss(const RelativeInput& input) {
  constexpr double kFound_s = 0.15;
  const double age_s = input.pad_age_s;
  if (age_s < kFound_s && input.pad->Sigma(State::kVelocity) < kKnown_mps) {
    if (job_.lands) height_m_ = -input.pad->way().z();
    return Enter(GuidancePhase::kApproach, "the pad is back", input.now);
  }
  if (age_s <= kWiden_s) return;
  if (age_s > lost_after_s_) return EndLoss(input);
  reason_ = job_.has_ceiling ? "the pad is lost: holds its height, below a ceiling"
                             : "the pad is lost: climbs to widen the view";
}

// LAND is level, and drifts with the wind: the UAV sinks against what it knows of the wind, where
// the climb rate is controlled, until it is low, or stands on something.
void RelativeGuidance::EndLoss(const RelativeInput& input) {
  if (input.has_pilot) return GiveUp(input, "the pad is lost: fly by hand, or it lands");
  constexpr double kSure_s = 0.3;   // one echo of a range finder is none
  constexpr double kSinking_s = 1;  // until it sinks
  const bool is_at_rest = input.pad_age_s > lost_after_s_ + kSinking_s &&
                          input.pad->ClimbSigma() < kKnownClimb_mps &&
                          input.pad->velocity().z() < kAtRest_mps;
  if (HeightWithoutPad(input) >= kLandBelow_m && !is_at_rest) {
    low_since_.reset();
  } else if (!low_since_) {
    low_since_ = input.now;
  }
  const bool is_low = low_since_ && ToSeconds(input.now - *low_since_) > kSure_s;
  if (is_low || !KnowsClimb(input)) {
    return GiveUp(input, "the pad is lost: lands where it is");
  }
  reason_ = "the pad is lost: sinks, against the wind as it was";
}

// ArduCopter controls it by itself.
bool RelativeGuidance::KnowsClimb(const RelativeInput& input) const {
  return !streams_ || input.pad->ClimbSigma() < kKnownClimb_mps;
}

// Height of the feet, m, above what is below, else above the pad.
double RelativeGuidance::HeightWithoutPad(const RelativeInput& input) const {
  const bool is_measured = input.pad->ClimbSigma() < kKnownClimb_mps;
  const double height_m = is_measured ? -input.pad->way().z() : lost_height_m_ - sunk_m_;
  return input.range_m.value_or(height_m) - options_.leg_m;
}

void RelativeGuidance::Descend(const RelativeInput& input) {
  const double feet_m = FeetHeight(input);
  const bool is_low = feet_m < options_.commit_height_m;
  reason_ = HasToTurn() ? kTurns : "";
  if (HasToTurn()) return;
  if (is_low && input.pad_age_s < kLost_s / 2 && IsAbove(input, options_.cone_m, kStill_mps)) {
    Enter(GuidancePhase::kCommit, "", input.now);
  }
}

// The camera is too near to see the pad.
void RelativeGuidance::Commit(const RelativeInput& input) {
  const bool is_down = input.is_landed || FeetHeight(input) < kContact_m;
  const bool is_long = ToSeconds(input.now - entered_) > kLongestCommit_s;
  if (!is_down && !is_long && input.pad_age_s < kCommitUnseen_s) return;
  Enter(GuidancePhase::kLanded, "on the pad: LAND", input.now);
}

double RelativeGuidance::FeetHeight(const RelativeInput& input) const {
  return -input.pad->way().z() - options_.leg_m;
}

double RelativeGuidance::Cone(double feet_m) const {
  return options_.cone_m + GuidanceOptions::kConeSlope * std::max(feet_m, 0.0);
}

bool RelativeGuidance::IsAbove(const RelativeInput& input, double radius_m,
                               double speed_mps) const {
  const double sigma_mps = input.pad->Sigma(State::kVelocity);
  return WayOfFeet(*input.pad, options_.leg_m).norm() < radius_m &&
         input.pad->velocity().head<2>().norm() < speed_mps + sigma_mps && sigma_mps < kKnown_mps;
}

// m/s, against the pad.
double RelativeGuidance::WantedClimb(const RelativeInput& input) const {
  constexpr double kSinkGain = 0.4, kFastest = 0.8, kSlowest = 0.25;
  const double feet_m = FeetHeight(input);
  switch (phase_) {
    case GuidancePhase::kSearch:
      if (input.pad_age_s > lost_after_s_) return -kBlindSink_mps;
      return input.pad_age_s > kWiden_s && !job_.has_ceiling ? kWiden_mps : 0;
    case GuidancePhase::kDescend: {
      const double least_m = options_.commit_height_m - 0.1;
      if (feet_m < least_m) return kHeightGain * (least_m - feet_m);
      if (!IsAbove(input, Cone(feet_m), 1) || HasToTurn()) return 0;
      return -std::clamp(kSinkGain * feet_m, kSlowest, kFastest);
    }
    case GuidancePhase::kCommit:
    case GuidancePhase::kLanded:
      return -options_.touchdown_sink_mps;
    default:
      return std::clamp(kHeightGain * (height_m_ + input.pad->way().z()), -kClimb_mps, kClimb_mps);
  }
}

RelativeSetPoint RelativeGuidance::Fly(const RelativeInput& input) {
  const double step_s = std::clamp(ToSeconds(input.now - last_), 0.0, kStepLimit_s);
  RelativeSetPoint command;
  Vector2d wanted = phase_ == GuidancePhase::kLanded ? Vector2d(0, 0) : WantedAcceleration(input);
  const Vector2d before = sent_.value_or(Limited(-input.pad->bias().head<2>(), MostLevel()));
  wanted = before + Limited(wanted - before, kJerk * step_s);
  command.climb_mps = WantedClimb(input);
  if (phase_ == GuidancePhase::kSearch) sunk_m_ -= step_s * command.climb_mps;
  command.turn = std::remainder(heading_.yaw() - input.nose, kFullTurn);
  const Vector3d velocity = input.pad->velocity();
  command.acceleration << wanted,
      std::clamp(kClimbGain * (command.climb_mps + velocity.z()) - input.pad->bias().z(),
                 -kMostVertical, kMostVertical);
  return command;
}

// The largest level acceleration, m/s^2.
double RelativeGuidance::MostLevel() const {
  constexpr double kTilt = Radians(20);
  return kGravity * std::tan(std::min(kTilt, Radians(options_.limits.max_tilt_deg)));
}

Vector2d RelativeGuidance::WantedAcceleration(const RelativeInput& input) const {
  const double most = MostLevel();
  const RelativePadState::Estimate& pad = *input.pad;
  const Vector2d against_bias = Limited(-pad.bias().head<2>(), most);
  if (!(pad.Sigma(State::kVelocity) < kKnown_mps)) return against_bias;
  const Gains gains = GainsFor(kAttitudeDelay_s + input.link_delay_s);
  if (phase_ == GuidancePhase::kSearch) {
    return Limited(gains.velocity * pad.velocity().head<2>() + against_bias, most);
  }
  const Vector2d way = job_.lands ? WayOfFeet(pad, options_.leg_m) : Vector2d(pad.way().head<2>());
  const Vector2d closing = Limited(gains.position / gains.velocity * way, kFastest_mps);
  const Vector2d following =
      gains.velocity * (pad.velocity().head<2>() + closing) + pad.pad_acceleration().head<2>();
  return Limited(following + against_bias, most);
}

}  // namespace kestrel
