// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kestrel/comms/mavlink/autopilot.h"
#include "kestrel/comms/mavlink/connection.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/flight/guidance/guidance.h"
#include "kestrel/flight/onboard/flight_options.h"
#include "kestrel/flight/onboard/refusal_warning.h"
#include "kestrel/flight/onboard/send_schedule.h"
#include "kestrel/flight/onboard/target_reporter.h"
#include "kestrel/vision/tracking/target_tracker.h"

namespace kestrel {

// Makes the guidance of a task. Throws InputError when the options are not valid.
using GuidanceMaker = std::function<std::unique_ptr<Guidance>(const GuidanceOptions& options)>;

// Flies the UAV by set-points of guidance while the pilot gives it the mode, and informs the user.
// Used by the link's thread only.
class GuidedFlight {
 public:
  // 'tracker': options of the predicted track. 'make': of the task. 'is_in_its_frame': the world is
  // the autopilot's local frame. 'report': receives lines for the user. Throws InputError when the
  // options are not valid, or the rate is too low for flying.
  GuidedFlight(const FlightOptions& options, const TargetTrackerOptions& tracker,
               GuidanceMaker make, bool is_in_its_frame, Autopilot* autopilot,
               Connection* connection, std::function<void(const std::string&)> report);

  // Sends what is due at 'now'; true when it was the first set-point of a new frame.
  bool Fly(Time now, const TrackSnapshot& track, const PoseHistory& poses);

  // Takes a person's order on what is marked.
  void Take(const FollowOrder& order) { order_ = order; }

  // The others of the UAV's team, who are where they fly on to until this is called again.
  void Take(TeamInFlight team) { team_ = std::move(team); }
  // Where objects are delivered.
  void set_box(const GlobalPosition& box) { box_ = box; }
  // A place on ground as high as that of the take-off: guidance has it as its target.
  void set_place(const GlobalPosition& place) { place_ = place; }
  // See Guidance.
  ObjectEnd ended() const { return guidance_->ended(); }
  bool is_at_work() const { return is_flying() && guidance_->is_at_work(); }
  // True from the take-off on, and where the autopilot does not report what it does.
  bool is_in_air() const {
    return autopilot_.is_armed() && autopilot_.landed_state() != LandedState::kOnGround;
  }
  bool wants_object() const { return is_flying() && guidance_->wants_object(); }

  // The autopilot's position comes from the pad, and is a guess without it.
  void set_position_by_pad() { is_position_by_pad_ = true; }
  bool is_position_by_pad() const { return is_position_by_pad_; }
  // The images come late by this time, which is known. See GuidanceInput::target_age_s.
  void set_video_delay(Duration delay) { video_delay_ = delay; }
  // The height of the ground at a place, in the world; nothing: as under home.
  void set_take_off_ground(std::optional<double> height_m) { take_off_ground_m_ = height_m; }
  // True when the autopilot's pose was known at the last set-point that was due.
  bool has_pose() const { return has_pose_; }

  // True while guidance flies the UAV and it has not landed.
  bool is_at_deck() const {
    return guidance_->is_at_deck() && (is_begun_ || phase() == GuidancePhase::kLanded);
  }
  bool is_flying() const { return is_begun_ && phase() != GuidancePhase::kLanded; }
  GuidancePhase phase() const { return guidance_->phase(); }
  // Angle of the nose off the wanted heading, rad; nothing: any heading will do, or the pad's is
  // not known.
  std::optional<double> heading_error() const { return guidance_->heading_error(); }
  int set_points() const { return set_points_; }  // sent
  // Why guidance gave up; empty: it flies, the pilot has taken over since, or it has not begun.
  std::string gave_up() const;
  // Part of the limits that following the target takes.
  const FollowingDemand& demand() const { return guidance_->demand(); }
  // True while that is more than there is.
  bool cannot_follow() const { return reported_cannot_follow_; }

 private:
  void KnowAutopilot(Time now);
  void PredictOthers(Time now);
  void WatchMode(const GuidanceInput& input, Time now);
  void ReportOtherMode(bool is_mode);
  void CheckPermission(const GuidanceInput& input, Time now);
  GuidanceInput Input(Time now, const TrackSnapshot& track, const PoseHistory& poses) const;
  std::optional<Eigen::Vector3d> InWorld(const std::optional<GlobalPosition>& position) const;
  void ShowPlace(GuidanceInput* input) const;
  // Not to a place that is outside of the geofence; 'name': of it.
  std::string WhyNotGoTo(const std::optional<GlobalPosition>& place, const char* name) const;
  std::optional<TargetEstimate> Target(Time now, const TrackSnapshot& track) const;
  void Request(Time now, GuidanceRequest request);
  bool RequestGripper(GuidanceRequest request);
  void ReportPhase(const GuidanceOutput& output);
  void ReportWhetherItKeepsUp(const GuidanceOutput& output);
  void ReportWhenContactIsUnseen(const GuidanceInput& input);
  void EndLostLanding(const GuidanceInput& input, Time now);
  void Notify(std::uint8_t severity, const std::string& text);

  FlightOptions options_;
  TurnNoise noise_;
  bool is_in_its_frame_;
  Autopilot& autopilot_;
  Connection* connection_;
  std::function<void(const std::string&)> report_;
  GuidanceMaker make_;
  std::unique_ptr<Guidance> guidance_;  // for this autopilot, once its parameters are known
  bool is_position_by_pad_ = false;
  Duration video_delay_{};
  std::optional<double> take_off_ground_m_;
  bool has_pose_ = false;
  FollowOrder order_;  // the newest one
  TeamInFlight team_;
  std::vector<OtherUav> others_;  // now
  std::optional<GlobalPosition> box_, place_;
  AutopilotKind kind_ = AutopilotKind::kUnknown;
  SendSchedule schedule_;

  bool was_mode_ = false;  // GUIDED or OFFBOARD was on
  bool was_other_mode_ = false;
  bool is_given_ = false;  // the pilot has given the mode, and guidance has not begun yet
  bool is_begun_ = false;
  bool was_armed_ = false;
  std::optional<Time> left_on_deck_;  // the mode was left in contact, without a position
  Time permission_due_{};
  bool may_begin_ = false;  // guidance may begin
  std::string refusal_;     // reason why it may not
  RefusalWarning warning_;
  RefusalWarning unknown_{0};  // PX4 leaves the mode soon
  bool knows_parameters_ = false;

  Time reported_frame_;  // the newest frame used for a set-point
  Time requested_{};     // when the autopilot was last sent a mode or a disarm command
  GuidancePhase reported_phase_ = GuidancePhase::kIdle;
  const char* reported_reason_ = "";
  bool reported_cannot_follow_ = false;
  std::optional<Time> in_contact_since_;
  bool reported_unseen_contact_ = false;
  int set_points_ = 0;
};

}  // namespace kestrel
