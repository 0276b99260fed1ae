// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/target_sender.h"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/comms/mavlink/ned.h"

namespace kestrel {
namespace {

// Parameters of ArduPilot: the delay that it assumes, and the place where it assumes the camera.
constexpr std::string_view kLag = "PLND_LAG", kCameraX = "PLND_CAM_POS_X",
                           kCameraY = "PLND_CAM_POS_Y", kCameraZ = "PLND_CAM_POS_Z";
constexpr std::array kParameters = {kLag, kCameraX, kCameraY, kCameraZ};
constexpr double kDefaultLag_s = 0.02;

}  // namespace

Duration LinkDelay(const FlightOptions& options, const Autopilot& autopilot) {
  return options.link_delay_s >= 0 ? DurationFromSeconds(options.link_delay_s)
                                   : autopilot.time_sync().round_trip() / 2;
}

TargetSender::TargetSender(const FlightOptions& options, const TargetTrackerOptions& tracker,
                           std::optional<LinkProfile> profile, double size_m, double sight_range_m,
                           bool is_guided, Autopilot* autopilot, Connection* connection,
                           std::function<void(const std::string&)> report)
    : options_(options),
      profile_(profile),
      size_m_(size_m),
      sight_range_m_(sight_range_m),
      is_guided_(is_guided),
      autopilot_(*autopilot),
      connection_(connection),
      report_(std::move(report)),
      reporter_(options.target, tracker),
      schedule_(options.rate_hz) {}

bool TargetSender::Send(Time now, const TrackSnapshot& track, const PoseHistory& poses) {
  ReportLanding();
  const bool is_news = track.captured != reported_frame_;
  if (!schedule_.IsDue(now, is_news) || !autopilot_.is_here()) return false;
  WantParameters();
  const LinkProfile profile = profile_.value_or(ProfileFor(autopilot_.kind()));
  auto report = reporter_.Report(now, UntilUse(), track, poses);
  ReportPhase();
  // PX4's target estimator filters by itself, and corrects the UAV's velocity by the messages. A
  // track contains the UAV's own estimate: sending it would close a loop. It gets the measurement
  // of each frame, with its time.
  if (report && !is_guided_) WarnOfSpeed(report->velocity_in_world);
  if (profile == LinkProfile::kPx4Vte) report = is_news ? track.sighting : std::nullopt;
  reported_frame_ = track.captured;
  if (!report) return false;
  report->size_m = size_m_;
  if (profile == LinkProfile::kArduPilot) {
    report->position_in_world -= report->world_from_body.rotation * CameraOfArduPilot();
  }
  if (!SendTarget(profile, options_.messages, *report, autopilot_, now, connection_)) return false;
  ++messages_;
  return is_news;
}

// Requests parameters only from an autopilot that has them.
void TargetSender::WantParameters() {
  if (requested_parameters_ || autopilot_.kind() != AutopilotKind::kArduPilot) return;
  requested_parameters_ = true;
  for (const std::string_view parameter : kParameters) autopilot_.parameters().Want(parameter);
}

// Place at which ArduPilot assumes the camera (FLU): it adds this place to the reported target,
// which is measured from the body's origin.
Eigen::Vector3d TargetSender::CameraOfArduPilot() const {
  const ParameterReader& parameters = autopilot_.parameters();
  const auto in_frd = [&](std::string_view name) { return parameters.Find(name).value_or(0); };
  return FluFromFrd({in_frd(kCameraX), in_frd(kCameraY), in_frd(kCameraZ)});
}

// The link's delay, minus the age that ArduPilot assumes for a target.
Duration TargetSender::UntilUse() const {
  const Duration delay = LinkDelay(options_, autopilot_);
  if (autopilot_.kind() != AutopilotKind::kArduPilot) return delay;
  return delay - DurationFromSeconds(autopilot_.parameters().Find(kLag).value_or(kDefaultLag_s));
}

// Warns once, when it is sure.
void TargetSender::WarnOfSpeed(const Eigen::Vector3d& velocity) {
  constexpr double kStanding_mps = 1;
  constexpr int kSure = 50;  // messages in a row
  const double speed_mps = velocity.head<2>().norm();
  moving_messages_ = speed_mps > kStanding_mps ? moving_messages_ + 1 : 0;
  if (moving_messages_ != kSure || is_warned_) return;
  is_warned_ = true;
  const bool is_px4 = autopilot_.kind() == AutopilotKind::kPx4;
  report_(fmt::format(
      "the pattern moves at {:.1f} m/s: {}; kestrel fly --guide lands on it", speed_mps,
      is_px4
          ? "PX4's own precision landing is for patterns that stand, and trails behind this one"
          : "ArduPilot's own precision landing is for patterns that stand or drive straight, and "
            "comes down beside one in a curve"));
  autopilot_.Announce(mavlink::kSeverityWarning,
                      is_px4 ? "Kestrel: the pattern moves, PX4 will not land on it"
                             : "Kestrel: pattern moves, LAND misses it in a curve");
}

// Informs the user and the ground station when the target is found, lost, or stood on.
void TargetSender::ReportPhase() {
  const TargetPhase phase = reporter_.phase();
  if (phase == reported_phase_) return;
  reported_phase_ = phase;
  std::string text;
  std::uint8_t severity = mavlink::kSeverityInfo;
  switch (phase) {
    case TargetPhase::kSearching:
      return;
    case TargetPhase::kFound:
      text = fmt::format("pattern found, {:.1f} m below", reporter_.height_m());
      break;
    case TargetPhase::kLost:
      text = "pattern lost";
      severity = mavlink::kSeverityWarning;
      break;
    case TargetPhase::kContact:
      text = "on the pattern";
      break;
  }
  report_(text);
  autopilot_.Announce(severity, "Kestrel: " + text);
}

// Informs them when the autopilot begins to land by it. Without a pattern in view it comes down
// where it is.
void TargetSender::ReportLanding() {
  const bool begins = autopilot_.is_landing_mode() && autopilot_.is_armed() && !was_landing_;
  was_landing_ = autopilot_.is_landing_mode() && autopilot_.is_armed();
  if (!begins) return;
  if (phase() == TargetPhase::kFound || phase() == TargetPhase::kContact || is_guided_ ||
      sight_range_m_ <= 0) {
    return autopilot_.Announce(mavlink::kSeverityInfo,
                               fmt::format("Kestrel: landing, pattern {}", ToString(phase())));
  }
  report_(fmt::format(
      "the autopilot lands, and the pattern is not in view: this camera sees it from {:.1f} m at "
      "most. Stop the landing, go lower above the pattern, and begin it again",
      sight_range_m_));
  autopilot_.Announce(
      mavlink::kSeverityWarning,
      fmt::format("Kestrel: no pattern in view: LAND below {:.1f} m", sight_range_m_));
}

}  // namespace kestrel
