// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/no_position_flight.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/comms/mavlink/set_point_message.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/flight/guidance/guidance.h"
#include "kestrel/flight/onboard/guidance_permission.h"
#include "kestrel/flight/onboard/target_sender.h"

namespace kestrel {
namespace {

constexpr double kAttitudeAge_s = 0.5;  // after so long without one it is not known
constexpr double kMessageAge_s = 0.5;   // after so long without a message the link is away
constexpr double kRangeAge_s = 0.5;     // of the range finder's newest distance
constexpr Duration kCheckPeriod = std::chrono::milliseconds(500);
constexpr Duration kHandOver = std::chrono::milliseconds(1500);  // longest wait for GUIDED_NOGPS
constexpr Duration kRepeatPeriod = std::chrono::milliseconds(300);
constexpr std::string_view kArduPilotOptions = "GUID_OPTIONS";
constexpr unsigned kTakesThrust = 8;  // of GUID_OPTIONS: thrust is no climb rate
// ArduCopter's WP_SPD_UP and WP_SPD_DN as they come.
constexpr double kClimb_mps = 2.5, kSink_mps = 1.5;

}  // namespace

NoPositionFlight::NoPositionFlight(const FlightOptions& options, const RelativeJob& job,
                                   Autopilot* autopilot, Connection* connection,
                                   std::function<void(const std::string&)> report)
    : options_(options),
      job_(job),
      autopilot_(*autopilot),
      connection_(connection),
      report_(std::move(report)),
      pad_(job.pad_moves),
      guidance_(std::in_place, options.guidance, job, /*streams=*/false),
      schedule_(options.rate_hz) {}

void NoPositionFlight::TakeAttitude(const PoseSample& attitude) {
  const Eigen::Vector3d rate =
      attitude.motion ? attitude.motion->rate_in_body : Eigen::Vector3d(0, 0, 0);
  const Eigen::Quaterniond& rotation = attitude.world_from_body.rotation;
  if (!pad_.AddAttitude(attitude.time, rotation, rate)) return;
  attitude_time_ = attitude.time;
  heading_ = HeadingOf(rotation);
}

void NoPositionFlight::TakeAcceleration(Time time, const Eigen::Vector3d& acceleration) {
  pad_.AddAcceleration(time, acceleration);
}

// PX4 sends 0 where it does not know it.
void NoPositionFlight::TakeClimb(double climb_mps) {
  const auto& estimator = autopilot_.status().estimator();
  if (estimator && (estimator->flags & mavlink::kEstimatorVelocityVertical) == 0) return;
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  pad_.AddOwnVelocity({kUnknown, kUnknown, climb_mps});
}

// Without such a measurement its velocity is a guess.
void NoPositionFlight::TakePose(const PoseSample& pose) {
  const auto& estimator = autopilot_.status().estimator();
  // After a loss of GNSS the estimator guesses for seconds, and says nothing of it.
  if (job_.is_reserve) return;
  if (!estimator || !pose.motion || (estimator->flags & mavlink::kEstimatorConstantPosition) != 0 ||
      (estimator->flags & mavlink::kEstimatorVelocityHorizontal) == 0) {
    return;
  }
  pad_.AddOwnVelocity(pose.motion->velocity_in_world);
}

void NoPositionFlight::WatchPosition(Time now, bool is_flown) {
  KnowAutopilot(now);
  const bool is_lost = loss_.IsLost(autopilot_);
  if (is_in_charge() || !is_flown || kind_ == AutopilotKind::kUnknown) return;
  CheckReserve(now);
  // The pilot may have taken over since guidance flew last.
  if (!is_lost || !autopilot_.is_guided_mode() || !refusal_.empty()) return;
  const RelativeInput input = Input(now);
  if (!RelativeGuidance::CanBegin(input)) return;
  took_over_ = now;
  Notify(mavlink::kSeverityWarning, "the position is lost: lands by the pad alone");
  guidance_->Update(input);  // it has not begun
  was_mode_ = is_given_ = IsMode();
  was_armed_ = was_refused_mode_ = true;
  is_handing_over_ = !was_mode_;
  if (is_handing_over_) autopilot_.RequestMode(FlightMode::kGuidedByLean);
}

void NoPositionFlight::CheckReserve(Time now) {
  if (now < permission_due_) return;
  permission_due_ = now + kCheckPeriod;
  refusal_ = WhyNot(now);
  if (warning_.IsDue(/*is_flying=*/true, refusal_.empty(), now)) {
    Notify(mavlink::kSeverityWarning, "a loss of GNSS would end the landing: " + refusal_);
  }
}

// The flight by position goes on where the pilot leaves the mode, or begins the next flight.
void NoPositionFlight::EndReserve(bool is_mode, bool is_armed) {
  if (is_mode || !autopilot_.is_guided_mode()) is_handing_over_ = false;
  const bool is_left = !is_mode && !is_handing_over_ && !autopilot_.is_descent();
  if (is_left || (is_armed && !was_armed_)) took_over_.reset();
}

void NoPositionFlight::AddSight(Time now, const TrackSnapshot& track) {
  const TrackSnapshot::Sight& sight = *track.sight;
  reported_frame_ = sight.time;
  const RigidTransform body_from_target = sight.target_from_body.Inverse();
  if (!pad_.AddSight(sight.time, body_from_target.translation, sight.covariance)) return;
  delay_s_ = std::min(ToSeconds(now - sight.time), GuidanceInput::kMostVideoDelay_s);
  if (const auto level_from_body = pad_.LevelFromBodyAt(sight.time)) {
    pad_heading_.Add(sight.time, HeadingOf(*level_from_body * body_from_target.rotation),
                     sight.heading_sigma, sight.heading_symmetry);
  }
}

bool NoPositionFlight::Fly(Time now, const TrackSnapshot& track) {
  const bool is_news = track.sight && track.sight->time != reported_frame_;
  if (is_news) AddSight(now, track);
  if (!is_in_charge() || !schedule_.IsDue(now, is_news)) return false;
  KnowAutopilot(now);
  if (kind_ == AutopilotKind::kUnknown) return false;
  RelativeInput input = Input(now);
  WatchMode(now, input.pad.has_value());
  input.is_guided = is_begun_;
  input.is_allowed = refusal_.empty();
  const RelativeOutput output = guidance_->Update(input);
  WatchPad(input);
  ReportPhase(output);
  Request(output.request, now);
  // The pad's estimate counts on what is sent.
  pad_.set_climb_acceleration(0);
  const bool may_send = is_begun_ || (refusal_.empty() && !IsMode());
  if (!output.set_point || !may_send || !Send(*output.set_point, now)) return false;
  ++set_points_;
  return is_news && is_begun_;
}

void NoPositionFlight::WatchPad(const RelativeInput& input) {
  constexpr double kLost_s = 1;
  if (phase() == GuidancePhase::kLanded) {
    target_phase_ = TargetPhase::kContact;
  } else if (input.pad && input.pad_age_s < kLost_s) {
    target_phase_ = TargetPhase::kFound;
    height_m_ = -input.pad->way().z();
  } else if (target_phase_ != TargetPhase::kSearching) {
    target_phase_ = TargetPhase::kLost;
  }
}

void NoPositionFlight::KnowAutopilot(Time now) {
  if (!autopilot_.is_here() || autopilot_.kind() == kind_) return;
  kind_ = autopilot_.kind();
  WantGuidanceParameters(&autopilot_);
  const bool is_px4 = kind_ == AutopilotKind::kPx4;
  if (!is_px4) autopilot_.parameters().Want(kArduPilotOptions);
  guidance_.emplace(options_.guidance, job_, /*streams=*/is_px4);
  permission_due_ = now;
  was_mode_ = IsMode();
  if (is_in_charge() && was_mode_ && autopilot_.is_armed()) {
    Notify(mavlink::kSeverityWarning,
           fmt::format("{} was on before: leave it and give it again", autopilot_.mode_name()));
  }
}

bool NoPositionFlight::IsMode() const {
  return IsGuidedByLeanMode(autopilot_.kind(), autopilot_.custom_mode());
}

// Begins when the pilot has given the mode and the UAV is in the air, unless there is a refusal;
// the pilot must then give the mode anew.
void NoPositionFlight::WatchMode(Time now, bool is_seen) {
  const bool is_armed = autopilot_.is_armed();
  const bool is_mode = IsMode();
  if (took_over_ && autopilot_.is_here()) EndReserve(is_mode, is_armed);
  if (was_armed_ && !is_armed) guidance_->Rearm();
  was_armed_ = is_armed;
  if (!autopilot_.is_here()) return;
  if (is_mode && !was_mode_) is_given_ = true;
  if (!is_mode) is_given_ = is_begun_ = false;
  if (is_mode) has_requested_land_ = false;
  was_mode_ = is_mode;
  if (!is_begun_ && now >= permission_due_) {
    permission_due_ = now + kCheckPeriod;
    refusal_ = WhyNot(now);
  }
  const bool is_flying = is_armed && IsInFlight(autopilot_.landed_state());
  const bool is_own_landing = has_requested_land_ && autopilot_.is_descent();
  if (warning_.IsDue(is_flying, is_begun_ || refusal_.empty() || is_own_landing, now)) {
    Notify(mavlink::kSeverityWarning, "guidance would be refused now: " + refusal_);
  }
  if (unknown_.IsDue(is_given_ && is_armed, autopilot_.landed_state() != LandedState::kUnknown,
                     now)) {
    Notify(mavlink::kSeverityWarning, kNotKnownToFly);
  }
  const bool is_other = autopilot_.is_guided_mode() && !is_mode;
  if (is_other && !was_refused_mode_) {
    Notify(mavlink::kSeverityWarning, "GUIDED needs a position: give GUIDED_NOGPS");
  }
  was_refused_mode_ = is_other;
  const bool is_stuck = is_handing_over_ && now - *took_over_ > kHandOver;
  if (is_stuck) Request(GuidanceRequest::kLand, now);
  if (!is_given_ || is_begun_ || !is_flying) return;
  is_given_ = false;
  refusal_ = WhyNot(now);
  // Guidance then ends the mode, in which the UAV would drift.
  if (!refusal_.empty()) Notify(mavlink::kSeverityWarning, "guidance refused: " + refusal_);
  is_begun_ = true;
  // The autopilot's own height control flew so far, and its thrust was not commanded.
  if (kind_ == AutopilotKind::kPx4 && is_seen) pad_.ForgetThrust();
}

std::string NoPositionFlight::WhyNot(Time now) const {
  if (std::string why = WhyNotFly(autopilot_, /*has_position=*/false); !why.empty()) return why;
  if (!autopilot_.parameters().is_done()) return "the autopilot's parameters are not read yet";
  const auto flags = autopilot_.parameters().Find(kArduPilotOptions);
  if (flags && (static_cast<unsigned>(*flags) & kTakesThrust) != 0) {
    return "GUID_OPTIONS has bit 3: expected thrust as a climb rate";
  }
  if (const std::string unsafe = UnsafeLoss(autopilot_, /*is_position_by_pad=*/true);
      !unsafe.empty() && !options_.guidance.accept_unsafe_loss) {
    return unsafe;
  }
  if (ToSeconds(now - attitude_time_) > kAttitudeAge_s) return "no attitude is sent";
  return "";
}

RelativeInput NoPositionFlight::Input(Time now) {
  const Duration link_delay = LinkDelay(options_, autopilot_);
  RelativeInput input;
  input.now = now;
  input.pad = pad_.At(now + link_delay);
  if (pad_.sighted()) {
    input.pad_age_s = std::max(ToSeconds(now - *pad_.sighted()) - delay_s_, 0.0);
  }
  if (const auto range = autopilot_.range(); range && ToSeconds(now - range->time) < kRangeAge_s) {
    input.range_m = range->distance_m;
  }
  input.pad_heading = pad_heading_.At(now);
  input.nose = pad_.Nose();
  input.is_armed = autopilot_.is_armed();
  input.is_landed = autopilot_.landed_state() == LandedState::kOnGround;
  input.is_link_up = ToSeconds(now - autopilot_.received()) < kMessageAge_s;
  input.has_attitude = ToSeconds(now - attitude_time_) < kAttitudeAge_s;
  input.has_pilot = autopilot_.status().HasPilot(now);
  input.mode_age_s = ToSeconds(now - autopilot_.mode_reported());
  input.link_delay_s = ToSeconds(link_delay);
  return input;
}

bool NoPositionFlight::Send(const RelativeSetPoint& set_point, Time now) {
  const Eigen::AngleAxisd world_from_level(heading_, Eigen::Vector3d::UnitZ());
  LeanSetPoint sent;
  sent.acceleration = world_from_level * set_point.acceleration;
  sent.climb_mps = set_point.climb_mps;
  sent.yaw = heading_ + set_point.turn;
  const AutopilotLimits limits = LimitsOf(autopilot_);
  if (!SendSetPoint(sent, limits.max_climb_mps.value_or(kClimb_mps),
                    limits.max_sink_mps.value_or(kSink_mps), autopilot_, now, connection_)) {
    return false;
  }
  if (is_begun_ && kind_ == AutopilotKind::kPx4) {
    pad_.set_climb_acceleration(set_point.acceleration.z());
  }
  return true;
}

void NoPositionFlight::Request(GuidanceRequest request, Time now) {
  if (request == GuidanceRequest::kNone || now < request_due_) return;
  request_due_ = now + kRepeatPeriod;
  has_requested_land_ = request != GuidanceRequest::kAltitude;
  autopilot_.RequestMode(has_requested_land_ ? FlightMode::kLand : FlightMode::kAltitude);
}

void NoPositionFlight::ReportPhase(const RelativeOutput& output) {
  if (output.phase == reported_phase_ && output.reason == reported_reason_) return;
  reported_phase_ = output.phase;
  reported_reason_ = output.reason;
  Notify(mavlink::kSeverityInfo,
         fmt::format("{}{}{}", ToString(output.phase), reported_reason_.empty() ? "" : ": ",
                     reported_reason_));
}

void NoPositionFlight::Notify(std::uint8_t severity, const std::string& text) {
  report_(text);
  autopilot_.Announce(severity, "Kestrel: " + text);
}

}  // namespace kestrel
