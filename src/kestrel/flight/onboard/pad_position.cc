// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/pad_position.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/core/base/parse_number.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/core/poses/gravity.h"

namespace kestrel {
namespace {

constexpr std::size_t kKeptAttitudes = 256;  // some seconds
constexpr Duration kAttitudeGap = std::chrono::milliseconds(200);
constexpr Duration kUsePatience = std::chrono::seconds(8);     // until the position must be in use
constexpr Duration kOriginPatience = std::chrono::seconds(3);  // it may have one already
constexpr double kKnown_s = 1;

// Parameters of ArduPilot and of PX4 that let them use it.
constexpr std::string_view kArduPilotType = "VISO_TYPE", kArduPilotPlace = "EK3_SRC1_POSXY",
                           kArduPilotHeading = "EK3_SRC1_YAW", kPx4Control = "EKF2_EV_CTRL";
constexpr std::array kArduPilotParameters = {kArduPilotType, kArduPilotPlace, kArduPilotHeading};
constexpr int kExternal = 6;  // a source of ArduPilot's EKF
constexpr unsigned kPx4UsesPlace = 1;

}  // namespace

PadPosition::PadPosition(std::optional<GlobalPosition> origin, Autopilot* autopilot,
                         Connection* connection, std::function<void(const std::string&)> report)
    : origin_(origin),
      autopilot_(*autopilot),
      connection_(connection),
      report_(std::move(report)),
      attitudes_(kKeptAttitudes, kAttitudeGap) {}

void PadPosition::TakeAttitude(const PoseSample& sample) { attitudes_.Add(sample); }

// The attitude turns little between two of its reports.
void PadPosition::TakeAcceleration(Time time, const Eigen::Vector3d& acceleration) {
  const auto attitude = attitudes_.Predict(time, kAttitudeGap, {});
  if (!attitude) return;
  const bool is_by_pad = HeadingOfEstimator() == HeadingSource::kPad;
  const Eigen::AngleAxisd frame_from_world(is_by_pad ? -place_.heading_drift() : 0,
                                           Eigen::Vector3d::UnitZ());
  motion_.AddAcceleration(time,
                          frame_from_world * (attitude->world_from_body.rotation * acceleration) -
                              kGravity * Eigen::Vector3d::UnitZ());
}

void PadPosition::Send(Time now, const TrackSnapshot& track) {
  if (!autopilot_.is_here()) return;
  if (!heard_ || autopilot_.restarts() != restarts_) BeginWith(now);
  WantParameters();
  SendOrigin(now);
  ReportState(now);
  const auto& sight = track.sight;
  if (!sight || sight->time == newest_ || !autopilot_.parameters().is_done()) return;
  const auto attitude = attitudes_.Predict(sight->time, kAttitudeGap, {});
  if (!attitude || !autopilot_.time_sync().is_known()) return;
  constexpr std::int64_t kNsPerUs = 1000;
  const std::int64_t stamp_ns = autopilot_.time_sync().ToRemote(sight->time);
  if (stamp_ns <= 0) return;
  newest_ = sight->time;
  const ExternalPose pose =
      place_.Update(*sight, attitude->world_from_body.rotation, HeadingOfEstimator());
  WatchPad(pose);
  if (is_moving_) return known_.reset();
  known_ = sight->time;
  const bool counts_unreported = autopilot_.kind() != AutopilotKind::kPx4;
  is_used_ = is_used_ || autopilot_.is_position_good(now).value_or(counts_unreported);
  if (!first_) first_ = now;
  connection_->Send(
      OdometryOf(pose, autopilot_.kind(), static_cast<std::uint64_t>(stamp_ns / kNsPerUs)));
}

// An autopilot that has started again has no origin any more.
void PadPosition::BeginWith(Time now) {
  restarts_ = autopilot_.restarts();
  heard_ = now;
  first_.reset();
  is_origin_settled_ = was_checked_ = was_clock_missed_ = false;
}

bool PadPosition::is_seen(Time now) const { return known_ && ToSeconds(now - *known_) < kKnown_s; }

bool PadPosition::is_known(Time now) const { return is_used_ && is_seen(now); }

// A pad that moves would take the world along. On the ground the UAV is pushed and turned by hand.
void PadPosition::WatchPad(const ExternalPose& pose) {
  const bool is_flying = autopilot_.is_armed() && IsInFlight(autopilot_.landed_state());
  if (!is_flying) is_moving_ = false;
  if (!is_flying || pose.resets != std::exchange(watched_resets_, pose.resets)) motion_.Reset();
  if (!motion_.Update(pose.time, pose.frame_from_body.translation)) return;
  if (!is_moving_) {
    Notify(mavlink::kSeverityWarning, "the pad moves: it is no position any more");
  }
  is_moving_ = true;
}

void PadPosition::WantParameters() {
  if (std::exchange(requested_parameters_, true)) return;
  ParameterReader& parameters = autopilot_.parameters();
  if (autopilot_.kind() == AutopilotKind::kPx4) return parameters.Want(kPx4Control);
  for (const std::string_view name : kArduPilotParameters) parameters.Want(name);
}

// PX4 takes the heading of the message with the place, or turns the place itself.
HeadingSource PadPosition::HeadingOfEstimator() const {
  if (autopilot_.kind() == AutopilotKind::kPx4) return HeadingSource::kPad;
  return autopilot_.parameters().Find(kArduPilotHeading) == kExternal ? HeadingSource::kPad
                                                                      : HeadingSource::kAutopilot;
}

// Without an origin ArduPilot has no failsafe of its estimator. Its earth field comes from there,
// too, so that it must be near the true place.
void PadPosition::SendOrigin(Time now) {
  if (is_origin_settled_ || now - *heard_ < kOriginPatience) return;
  is_origin_settled_ = true;
  if (autopilot_.origin()) return;
  if (!origin_ && autopilot_.kind() == AutopilotKind::kPx4) return;  // it needs none
  if (!origin_) {
    return Notify(mavlink::kSeverityWarning,
                  "the autopilot has no origin: set one at the ground station, or fly.pad_origin");
  }
  constexpr double kMillimetres = 1e3;
  mavlink::SetGpsGlobalOrigin message;
  message.target_system = autopilot_.system();
  message.latitude = origin_->latitude_e7;
  message.longitude = origin_->longitude_e7;
  // With another altitude PX4 moves its frame up or down. ArduPilot reports none, and repeats a
  // text each second where it is 0.
  constexpr double kUnknown_m = 1;
  const double altitude_m = autopilot_.status().frame_altitude_m().value_or(kUnknown_m);
  message.altitude = static_cast<std::int32_t>(std::lround(kMillimetres * altitude_m));
  connection_->Send(message);
  Notify(mavlink::kSeverityInfo, "the autopilot's origin is set to fly.pad_origin");
}

void PadPosition::ReportState(Time now) {
  if (!was_checked_ && first_ && now - *first_ > kUsePatience) {
    was_checked_ = true;
    if (const std::string why = WhyUnused(now); !why.empty()) {
      Notify(mavlink::kSeverityWarning, "the autopilot does not use the pad's position: " + why);
    }
  }
  const bool has_clock = autopilot_.time_sync().is_known();
  if (!has_clock && !std::exchange(was_clock_missed_, now - *heard_ > kUsePatience) &&
      was_clock_missed_) {
    Notify(mavlink::kSeverityWarning,
           "the autopilot's clock is not known: no position is sent; expected a line on which "
           "TIMESYNC is answered");
  }
  if (!is_seen(now)) is_used_ = false;
  if (const bool knows = is_known(now); knows != was_known_) {
    was_known_ = knows;
    Notify(knows ? mavlink::kSeverityInfo : mavlink::kSeverityWarning,
           knows ? "position by the pad" : "no position by the pad");
  }
  if (place_.resets() != reported_resets_) {
    reported_resets_ = place_.resets();
    Notify(mavlink::kSeverityWarning, "the pad's position has jumped: another pad?");
  }
  constexpr double kTurned = Radians(20);
  if (!is_turned_ && std::abs(place_.heading_drift()) > kTurned) {
    is_turned_ = true;
    Notify(mavlink::kSeverityWarning,
           fmt::format("the autopilot's heading has turned by {:.0f} degrees against the pad: the "
                       "compass is disturbed",
                       Degrees(place_.heading_drift())));
  }
}

// Empty: it is used.
std::string PadPosition::WhyUnused(Time now) const {
  const ParameterReader& parameters = autopilot_.parameters();
  if (autopilot_.kind() == AutopilotKind::kPx4) {
    const auto control = parameters.Find(kPx4Control);
    if (control && (static_cast<unsigned>(*control) & kPx4UsesPlace) == 0) {
      return "set EKF2_EV_CTRL to 11 (place, height, heading)";
    }
  } else {
    if (parameters.Find(kArduPilotType) == 0) return "set VISO_TYPE to 1, and restart it";
    const auto place = parameters.Find(kArduPilotPlace);
    if (place && *place != kExternal) return "set EK3_SRC1_POSXY to 6";
  }
  return autopilot_.is_position_good(now).value_or(true) ? ""
                                                         : "its estimator reports no good position";
}

void PadPosition::Notify(std::uint8_t severity, const std::string& text) {
  report_(text);
  autopilot_.Announce(severity, "Kestrel: " + text);
}

}  // namespace kestrel
