// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/guided_flight.h"

#include <algorithm>
#include <chrono>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/comms/mavlink/set_point_message.h"
#include "kestrel/core/base/error.h"
#include "kestrel/flight/onboard/guidance_permission.h"
#include "kestrel/flight/onboard/target_sender.h"

namespace kestrel {
namespace {

constexpr double kMinRate_hz = 20;  // lowest rate that guidance is made for
constexpr double kMaxFrameAge_s = 1;
constexpr double kLinkAge_s = 0.5;  // after so long without a pose the link is away
constexpr Duration kPermissionPeriod = std::chrono::milliseconds(500);
constexpr Duration kRequestPeriod = std::chrono::seconds(1);
constexpr double kRequestLandAfter_s = 10;

const FlightOptions& CheckedRate(const FlightOptions& options) {
  if (options.rate_hz < kMinRate_hz) {
    throw InputError(fmt::format("--rate {:g}: guidance needs at least {:g} set-points per second",
                                 options.rate_hz, kMinRate_hz));
  }
  return options;
}

// A late link reports where the UAV was. In curves the velocity has changed by metres per second
// since.
UavState StateOf(const PredictedPose& pose, const Eigen::Vector3d& acceleration) {
  UavState uav{pose.world_from_body, pose.motion.velocity_in_world, pose.uncertainty.position_m};
  const Eigen::Vector3d change = pose.ahead_s * acceleration;
  uav.velocity_in_world += change;
  uav.world_from_body.translation += 0.5 * pose.ahead_s * change;
  return uav;
}

}  // namespace

GuidedFlight::GuidedFlight(const FlightOptions& options, const TargetTrackerOptions& tracker,
                           GuidanceMaker make, bool is_in_its_frame, Autopilot* autopilot,
                           Connection* connection, std::function<void(const std::string&)> report)
    : options_(CheckedRate(options)),
      noise_(tracker.Noise()),
      is_in_its_frame_(is_in_its_frame),
      autopilot_(*autopilot),
      connection_(connection),
      report_(std::move(report)),
      make_(std::move(make)),
      guidance_(make_(options.guidance)),
      schedule_(options.rate_hz) {}

bool GuidedFlight::Fly(Time now, const TrackSnapshot& track, const PoseHistory& poses) {
  const bool is_news = track.captured != reported_frame_;
  if (!schedule_.IsDue(now, is_news)) return false;
  KnowAutopilot(now);
  if (kind_ == AutopilotKind::kUnknown) return false;
  PredictOthers(now);
  GuidanceInput input = Input(now, track, poses);
  has_pose_ = input.uav.has_value();
  WatchMode(input, now);
  input.is_guided = is_begun_;
  const GuidanceOutput output = guidance_->Update(input);
  ReportPhase(output);
  ReportWhetherItKeepsUp(output);
  ReportWhenContactIsUnseen(input);
  Request(now, output.request);
  EndLostLanding(input, now);
  reported_frame_ = track.captured;
  const bool is_allowed = is_begun_ || may_begin_;
  if (!output.set_point || !is_allowed) return false;
  if (!SendSetPoint(*output.set_point, autopilot_, now, connection_)) return false;
  ++set_points_;
  return is_news && is_begun_;
}

std::string GuidedFlight::gave_up() const {
  if (!guidance_->has_given_up()) return "";
  constexpr std::string_view kEnding = ": gave up";
  std::string reason = reported_reason_;
  if (reason.ends_with(kEnding)) reason.resize(reason.size() - kEnding.size());
  return reason;
}

// Prepares guidance for the autopilot once it is heard. A mode that is already on then was not
// given to this program.
void GuidedFlight::KnowAutopilot(Time now) {
  if (!autopilot_.is_here() || autopilot_.kind() == kind_) return;
  kind_ = autopilot_.kind();
  WantGuidanceParameters(&autopilot_);
  permission_due_ = now;
  was_mode_ = autopilot_.is_guided_mode();
  if (was_mode_ && autopilot_.is_armed()) {
    Notify(mavlink::kSeverityWarning,
           fmt::format("{} was on before: leave it and give it again", autopilot_.mode_name()));
  }
}

// Begins when the pilot has given the mode and the UAV is in the air (a take-off in the same mode
// belongs to the autopilot), unless there is a refusal; the pilot must then give the mode anew.
void GuidedFlight::WatchMode(const GuidanceInput& input, Time now) {
  const bool is_mode = autopilot_.is_here() ? autopilot_.is_guided_mode() : was_mode_;
  if (is_mode && !was_mode_) is_given_ = true;
  const bool is_landing = autopilot_.is_descent();
  if (!is_mode && is_begun_ && phase() == GuidancePhase::kLanded && !input.uav && !is_landing) {
    left_on_deck_ = now;
    Notify(mavlink::kSeverityWarning,
           "the autopilot has left its mode on the deck, without a position");
  }
  if (!is_mode) is_given_ = is_begun_ = false;
  was_mode_ = is_mode;
  ReportOtherMode(is_mode);
  if (was_armed_ && !input.is_armed) guidance_->Rearm();
  was_armed_ = input.is_armed;
  if (!is_begun_ && now >= permission_due_) CheckPermission(input, now);
  const bool is_flying = input.is_armed && IsInFlight(autopilot_.landed_state());
  const bool is_own_landing = is_landing && phase() == GuidancePhase::kLanded;
  if (warning_.IsDue(is_flying, is_begun_ || may_begin_ || is_own_landing, now)) {
    Notify(mavlink::kSeverityWarning, "guidance would be refused now: " + refusal_);
  }
  if (unknown_.IsDue(is_given_ && input.is_armed,
                     autopilot_.landed_state() != LandedState::kUnknown, now)) {
    Notify(mavlink::kSeverityWarning, kNotKnownToFly);
  }
  if (!is_given_ || is_begun_ || !is_flying) return;
  CheckPermission(input, now);
  is_begun_ = may_begin_;
  is_given_ = false;
  if (const auto home = HomeOf(autopilot_)) guidance_->SetFenceCenter(home->head<2>());
  if (!is_begun_) Notify(mavlink::kSeverityWarning, "guidance refused: " + refusal_);
}

// ArduCopter's mode for a flight without a position, in which the UAV drifts.
void GuidedFlight::ReportOtherMode(bool is_mode) {
  const bool is_other = !is_mode && IsGuidedByLeanMode(kind_, autopilot_.custom_mode());
  if (is_other && !was_other_mode_) {
    Notify(mavlink::kSeverityWarning, "GUIDED_NOGPS is for --no-position: give GUIDED");
  }
  was_other_mode_ = is_other;
}

void GuidedFlight::CheckPermission(const GuidanceInput& input, Time now) {
  permission_due_ = now + kPermissionPeriod;
  refusal_ = input.uav
                 ? WhyNotGuide(autopilot_, options_.guidance,
                               input.uav->world_from_body.translation, now, is_position_by_pad_)
                 : "no position is sent";
  if (refusal_.empty()) refusal_ = WhyNotGoTo(box_, "box");
  if (refusal_.empty()) refusal_ = WhyNotGoTo(place_, "place");
  may_begin_ = refusal_.empty();
  if (knows_parameters_ || !autopilot_.parameters().is_done()) return;
  knows_parameters_ = true;
  guidance_ = make_(OptionsFor(autopilot_, options_.guidance, is_in_its_frame_));
  guidance_->Update(input);  // guidance has not begun
  if (const std::string unsafe = UnsafeLoss(autopilot_, is_position_by_pad_); !unsafe.empty()) {
    Notify(mavlink::kSeverityWarning, unsafe);
  }
}

void GuidedFlight::PredictOthers(Time now) {
  constexpr double kLongest_s = 2;  // who is not heard for longer stands still for all we know
  const double ahead_s = std::clamp(ToSeconds(now - team_.time), 0.0, kLongest_s);
  others_ = team_.others;
  for (OtherUav& other : others_) other.position += ahead_s * other.velocity;
}

GuidanceInput GuidedFlight::Input(Time now, const TrackSnapshot& track,
                                  const PoseHistory& poses) const {
  GuidanceInput input;
  input.now = now;
  const auto pose = poses.Predict(now, DurationFromSeconds(TargetReporterOptions::kMaxPoseAge_s),
                                  UnmodelledMotion());
  if (pose) input.uav = StateOf(*pose, poses.Acceleration());
  input.target = Target(now, track);
  if (track.sighting) {
    input.deck = DeckSighting{track.sighting->time, track.sighting->position_in_world.z(),
                              track.sighting->normal_in_world};
  }
  const double delay_s = std::min(ToSeconds(video_delay_), GuidanceInput::kMostVideoDelay_s);
  if (track.seen) input.target_age_s = std::max(ToSeconds(now - *track.seen) - delay_s, 0.0);
  input.mark = track.mark;
  input.order = order_;
  input.gripper = {autopilot_.gripper_answers(), autopilot_.is_gripper_accepted()};
  input.others = others_;
  input.layer = team_.layer;
  if (const auto box = InWorld(box_)) input.box = box->head<2>();
  input.can_hold = !is_position_by_pad_;
  input.is_armed = autopilot_.is_armed();
  input.is_landed = autopilot_.landed_state() == LandedState::kOnGround;
  input.is_link_up = ToSeconds(now - autopilot_.received()) < kLinkAge_s;
  input.is_camera_up = ToSeconds(now - track.captured) < kMaxFrameAge_s;
  input.mode_age_s = ToSeconds(now - autopilot_.mode_reported());
  input.link_delay_s = ToSeconds(LinkDelay(options_, autopilot_));
  ShowPlace(&input);
  return input;
}

// A place is always in sight, and stands.
void GuidedFlight::ShowPlace(GuidanceInput* input) const {
  if (!place_) return;
  input->mark = 0;
  input->target.reset();
  const auto place = InWorld(place_);
  const auto ground_m = take_off_ground_m_ ? take_off_ground_m_
                                           : GroundUnderHome(autopilot_, options_.guidance.leg_m);
  if (!place || !ground_m) return;
  TargetEstimate& target = input->target.emplace();
  target.time = input->now;
  target.motion.mean.head<3>() << place->head<2>(), *ground_m;
  input->target_age_s = 0;
  input->mark = 1;
}

// Once the world is known.
std::optional<Eigen::Vector3d> GuidedFlight::InWorld(
    const std::optional<GlobalPosition>& position) const {
  if (!position || !autopilot_.origin()) return std::nullopt;
  return LocalFromGlobal(kind_, *autopilot_.origin(), *position);
}

std::string GuidedFlight::WhyNotGoTo(const std::optional<GlobalPosition>& place,
                                     const char* name) const {
  const auto to = InWorld(place), home = InWorld(autopilot_.home());
  if (!to || !home) return {};
  const double distance_m = (*to - *home).head<2>().norm();
  const double radius_m = options_.guidance.limits.geofence_radius_m;
  if (distance_m <= radius_m) return {};
  return fmt::format("the {} is {:.0f} m from home, limits.geofence_radius_m is {:g}", name,
                     distance_m, radius_m);
}

std::optional<TargetEstimate> GuidedFlight::Target(Time now, const TrackSnapshot& track) const {
  if (!track.target || track.state == TrackState::kSearching || track.state == TrackState::kLost) {
    return std::nullopt;
  }
  const double ahead_s = ToSeconds(now - track.captured);
  return TargetEstimate{now, Propagate(track.target->motion, std::max(ahead_s, 0.0), noise_),
                        track.target->yaw_period};
}

void GuidedFlight::Request(Time now, GuidanceRequest request) {
  if (RequestGripper(request)) return;
  if (request == GuidanceRequest::kNone || now < requested_ + kRequestPeriod) return;
  if (autopilot_.is_request_pending()) return;
  requested_ = now;
  switch (request) {
    case GuidanceRequest::kNone:
    case GuidanceRequest::kGrab:
    case GuidanceRequest::kRelease:
      return;
    case GuidanceRequest::kLand:
      autopilot_.RequestMode(FlightMode::kLand);
      return;
    case GuidanceRequest::kHold:
      autopilot_.RequestMode(FlightMode::kHold);
      return;
    case GuidanceRequest::kAltitude:
      autopilot_.RequestMode(FlightMode::kAltitude);
      return;
    case GuidanceRequest::kDisarm:
      Notify(mavlink::kSeverityWarning, "disarming by force, in contact");
      autopilot_.DisarmByForce();
      return;
  }
}

// False when it is another request. The gripper is moved at once.
bool GuidedFlight::RequestGripper(GuidanceRequest request) {
  const bool grabs = request == GuidanceRequest::kGrab;
  if (!grabs && request != GuidanceRequest::kRelease) return false;
  if (!autopilot_.is_gripper_pending()) autopilot_.OperateGripper(grabs);
  return true;
}

// An autopilot without a position leaves the mode by itself, and may hold its place on the deck
// with the motors on. A pilot's mode is left alone.
void GuidedFlight::EndLostLanding(const GuidanceInput& input, Time now) {
  if (!left_on_deck_) return;
  const bool is_over = !input.is_armed || is_begun_ || input.uav.has_value() ||
                       ToSeconds(now - *left_on_deck_) > kRequestLandAfter_s;
  if (is_over) {
    left_on_deck_.reset();
  } else if (autopilot_.custom_mode() == CustomModeOf(kind_, FlightMode::kHold)) {
    Request(now, GuidanceRequest::kLand);
  }
}

void GuidedFlight::ReportPhase(const GuidanceOutput& output) {
  if (output.phase == reported_phase_ && output.reason == std::string_view(reported_reason_))
    return;
  reported_phase_ = output.phase;
  reported_reason_ = output.reason;
  Notify(mavlink::kSeverityInfo, fmt::format("{}{}{}", ToString(output.phase),
                                             *output.reason == '\0' ? "" : ": ", output.reason));
}

// Reports before the mode is given, too, that the target is too fast for the UAV.
void GuidedFlight::ReportWhetherItKeepsUp(const GuidanceOutput& output) {
  if (output.cannot_follow == reported_cannot_follow_) return;
  reported_cannot_follow_ = output.cannot_follow;
  if (!output.cannot_follow) return Notify(mavlink::kSeverityInfo, "can keep up with the target");
  Notify(mavlink::kSeverityWarning,
         "cannot keep up with the target: it needs " + guidance_->demand().InWords());
}

// The land detectors of autopilots take no deck that turns fast for ground: the rotors go on.
void GuidedFlight::ReportWhenContactIsUnseen(const GuidanceInput& input) {
  constexpr double kPatience_s = 8;
  if (phase() != GuidancePhase::kLanded || input.is_landed) {
    in_contact_since_.reset();
    reported_unseen_contact_ = false;
    return;
  }
  if (!in_contact_since_) in_contact_since_ = input.now;
  if (reported_unseen_contact_ || ToSeconds(input.now - *in_contact_since_) < kPatience_s) return;
  reported_unseen_contact_ = true;
  Notify(
      mavlink::kSeverityWarning,
      fmt::format("on the deck for {:g} s, and the autopilot does not see it: disarm by hand, or "
                  "set fly.guidance.disarm_after_s",
                  kPatience_s));
}

void GuidedFlight::Notify(std::uint8_t severity, const std::string& text) {
  report_(text);
  autopilot_.Announce(severity, "Kestrel: " + text);
}

}  // namespace kestrel
