// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "kestrel/comms/mavlink/autopilot.h"
#include "kestrel/comms/mavlink/connection.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/flight/guidance/pad_heading.h"
#include "kestrel/flight/guidance/relative_guidance.h"
#include "kestrel/flight/guidance/relative_pad_state.h"
#include "kestrel/flight/onboard/flight_options.h"
#include "kestrel/flight/onboard/position_loss.h"
#include "kestrel/flight/onboard/refusal_warning.h"
#include "kestrel/flight/onboard/send_schedule.h"
#include "kestrel/flight/session/flight_report.h"
#include "kestrel/flight/session/track_snapshot.h"

namespace kestrel {

// Flies the UAV over a pad and onto it while the autopilot has no position, when the pilot gives it
// GUIDED_NOGPS (ArduCopter) or OFFBOARD (PX4): by lean and climb, from where frames show the pad
// and from the autopilot's attitude. As a reserve it takes over from guided flight when the
// autopilot loses its position over the pad. Used by the link's thread only.
class NoPositionFlight {
 public:
  // 'report': receives lines for the user. Throws InputError when the options are not valid.
  NoPositionFlight(const FlightOptions& options, const RelativeJob& job, Autopilot* autopilot,
                   Connection* connection, std::function<void(const std::string&)> report);

  // Takes the autopilot's attitude and turn, on the local clock.
  void TakeAttitude(const PoseSample& attitude);
  // Takes what the autopilot's accelerometer measures (FLU, m/s^2), on the local clock.
  void TakeAcceleration(Time time, const Eigen::Vector3d& acceleration);
  // Takes how fast the UAV climbs by the autopilot's estimate (m/s).
  void TakeClimb(double climb_mps);
  // Takes a pose of an autopilot that measures its velocity, as by optical flow.
  void TakePose(const PoseSample& pose);
  // Takes over at 'now' if this is the reserve, the position is lost and the pad in view.
  // 'is_flown': the UAV flies by set-points, and is not on the deck.
  void WatchPosition(Time now, bool is_flown);
  // True until the autopilot has entered the mode for it.
  bool is_handing_over() const { return is_handing_over_; }
  // False: it is the reserve, and has not taken over in this flight, or the pilot has left its
  // mode.
  bool is_in_charge() const { return !job_.is_reserve || took_over_.has_value(); }
  // Sends what is due at 'now'; true when it was the first set-point of a new frame.
  bool Fly(Time now, const TrackSnapshot& track);

  GuidancePhase phase() const { return guidance_->phase(); }
  bool is_at_deck() const {
    return phase() == GuidancePhase::kLanded || phase() == GuidancePhase::kCommit;
  }
  bool is_flying() const { return guidance_->is_active() && !is_at_deck(); }
  // State of the pad, for the status line.
  TargetPhase target_phase() const { return target_phase_; }
  double height_m() const { return height_m_; }   // of the body above the pad, where it is found
  int set_points() const { return set_points_; }  // sent
  bool has_given_up() const { return guidance_->has_given_up(); }
  // See Guidance.
  std::optional<double> heading_error() const { return guidance_->heading_error(); }
  // Why guidance gave up; empty: it flies, the pilot has taken over since, or it has not begun.
  std::string gave_up() const { return has_given_up() ? reported_reason_ : ""; }

 private:
  void KnowAutopilot(Time now);
  void CheckReserve(Time now);
  void EndReserve(bool is_mode, bool is_armed);
  void AddSight(Time now, const TrackSnapshot& track);
  void WatchPad(const RelativeInput& input);
  void WatchMode(Time now, bool is_seen);
  bool IsMode() const;
  std::string WhyNot(Time now) const;
  RelativeInput Input(Time now);
  bool Send(const RelativeSetPoint& set_point, Time now);
  void Request(GuidanceRequest request, Time now);
  void ReportPhase(const RelativeOutput& output);
  void Notify(std::uint8_t severity, const std::string& text);

  FlightOptions options_;
  RelativeJob job_;
  Autopilot& autopilot_;
  Connection* connection_;
  std::function<void(const std::string&)> report_;
  RelativePadState pad_;
  PadHeading pad_heading_;
  std::optional<RelativeGuidance> guidance_;
  AutopilotKind kind_ = AutopilotKind::kUnknown;
  SendSchedule schedule_;
  PositionLoss loss_;
  std::optional<Time> took_over_;
  bool is_handing_over_ = false;
  bool has_requested_land_ = false;  // since the mode was given

  Time attitude_time_{};
  double heading_ = 0;  // by the autopilot, rad from east to north
  double delay_s_ = 0;  // of the newest frame that was used
  Time reported_frame_{};
  bool was_mode_ = false;
  bool is_given_ = false;  // the pilot has given the mode, and guidance has not begun yet
  bool is_begun_ = false;
  bool was_armed_ = false;
  bool was_refused_mode_ = false;  // the one that needs a position
  Time permission_due_{};
  std::string refusal_ = "the autopilot is not known yet";
  RefusalWarning warning_;
  RefusalWarning unknown_{0};  // PX4 leaves the mode soon
  Time request_due_{};
  GuidancePhase reported_phase_ = GuidancePhase::kIdle;
  std::string reported_reason_;
  TargetPhase target_phase_ = TargetPhase::kSearching;
  double height_m_ = 0;
  int set_points_ = 0;
};

}  // namespace kestrel
