// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>

#include "kestrel/core/base/time.h"
#include "kestrel/flight/guidance/guidance_options.h"
#include "kestrel/flight/guidance/guidance_phase.h"
#include "kestrel/flight/guidance/guidance_request.h"
#include "kestrel/flight/guidance/relative_pad_state.h"
#include "kestrel/flight/guidance/touchdown_heading.h"

namespace kestrel {

// The job over a pad, and facts of the place that only a person knows (docs/indoors.md).
struct RelativeJob {
  bool lands = true;         // otherwise it stays above the pad, at the height of the beginning
  bool pad_moves = false;    // the pad, or the floor below, may move
  bool has_ceiling = false;  // the UAV must not climb to look for the pad
  // It lands by the autopilot's position, and without it only once that is lost.
  bool is_reserve = false;
};

// All inputs of relative guidance at an instant.
struct RelativeInput {
  Time now;  // never earlier than the one before
  // Predicted to when a set-point takes effect; nothing: the pad was not seen yet.
  std::optional<RelativePadState::Estimate> pad;
  std::optional<double> range_m;  // to what is below, by the UAV's range finder
  // The pad's heading and that of the nose, in one frame; nothing: it is not known.
  std::optional<TargetEstimate> pad_heading;
  double nose = 0;
  double pad_age_s = 0;    // since the newest frame that showed the pad, without its usual delay
  bool is_guided = false;  // the mode in which the autopilot obeys these set-points
  bool is_allowed = true;  // false: there is a reason against it, and the mode is to be ended
  bool is_armed = false;
  bool is_landed = false;    // the autopilot reports that it is on the ground
  bool is_link_up = true;    // messages come from the autopilot
  bool has_attitude = true;  // and its attitude among them
  bool has_pilot = false;    // there is a transmitter, with the throttle in its middle
  double mode_age_s = 0;     // time since the autopilot reported its mode
  double link_delay_s = 0;   // from sending a set-point to its use
};

// A command for an autopilot that knows its attitude only, in axes of the UAV's heading: ahead, to
// the left, up. It takes the climb rate, or the acceleration of the climb as well.
struct RelativeSetPoint {
  Eigen::Vector3d acceleration{0, 0, 0};  // m/s^2
  double climb_mps = 0;
  double turn = 0;  // of the nose, counterclockwise, rad
};

struct RelativeOutput {
  std::optional<RelativeSetPoint> set_point;  // nothing: send none
  GuidancePhase phase = GuidancePhase::kIdle;
  GuidanceRequest request = GuidanceRequest::kNone;
  const char* reason = "";  // reason for the phase, for the user; a literal
};

// Flies a multicopter over a pad, with it, and onto it, while the autopilot has no position: by
// lean and climb alone. It begins when the pilot gives the mode while the pad is in view, and ends
// when he leaves it. A pad out of view is the dangerous case: the UAV then levels itself against
// wind and tilt error as they were learnt, climbs to widen the view unless there is a ceiling, and
// requests a landing, or the pilot's own mode, before it can have drifted far. Nothing that needs a
// position is ever requested. A state machine without clock, socket or thread; neither throws nor
// allocates.
class RelativeGuidance {
 public:
  // 'streams': set-points are sent before the mode is given, too, because the autopilot enters it
  // only then (PX4). Throws InputError when the options are not valid.
  RelativeGuidance(const GuidanceOptions& options, const RelativeJob& job, bool streams);

  // Returns whether the pad is in view, and its velocity known.
  static bool CanBegin(const RelativeInput& input);

  // Call it at 20 Hz or more.
  RelativeOutput Update(const RelativeInput& input);

  // Allows set-points before the mode is given again, after the pilot has left it.
  void Rearm() {
    if (!is_active_) may_stream_ = streams_;
  }

  GuidancePhase phase() const { return phase_; }
  bool is_active() const { return is_active_; }
  bool has_given_up() const { return has_given_up_; }
  // See TouchdownHeading.
  const std::optional<double>& heading_error() const { return heading_.error(); }

 private:
  struct Gains {
    double position;  // 1/s^2
    double velocity;  // 1/s
  };
  static Gains GainsFor(double delay_s);

  bool HasLink(const RelativeInput& input);
  void FollowMode(const RelativeInput& input);
  void Start(const RelativeInput& input);
  void End(const char* reason);
  void GiveUp(const RelativeInput& input, const char* reason);
  void Enter(GuidancePhase phase, const char* reason, Time now);
  void ChoosePhase(const RelativeInput& input);
  void Lose(const RelativeInput& input);
  void FollowLoss(const RelativeInput& input);
  void EndLoss(const RelativeInput& input);
  void Wait(const RelativeInput& input);
  void WatchHeading(const RelativeInput& input);
  bool HasToTurn() const;
  void Descend(const RelativeInput& input);
  void Commit(const RelativeInput& input);
  bool KnowsClimb(const RelativeInput& input) const;
  double FeetHeight(const RelativeInput& input) const;
  double HeightWithoutPad(const RelativeInput& input) const;
  double Cone(double feet_m) const;
  bool IsAbove(const RelativeInput& input, double radius_m, double speed_mps) const;
  double WantedClimb(const RelativeInput& input) const;
  RelativeSetPoint Fly(const RelativeInput& input);
  double MostLevel() const;
  Eigen::Vector2d WantedAcceleration(const RelativeInput& input) const;
  GuidanceRequest RequestEnd(const RelativeInput& input) const;

  GuidanceOptions options_;
  RelativeJob job_;
  TouchdownHeading heading_;
  bool ignores_heading_ = false;  // it was waited for in vain
  bool streams_;
  bool may_stream_;
  GuidancePhase phase_ = GuidancePhase::kIdle;
  const char* reason_;
  Time entered_;
  bool is_active_ = false;
  bool has_given_up_ = false;
  Time gave_up_;
  std::optional<bool> was_guided_;
  std::optional<Time> mode_wanted_since_;  // the link was gone until then
  double height_m_ = 0;                    // of the body above the pad, to hold
  // Without the pad: its age from which the UAV sinks, the height of the loss, and how far it has
  // sunk.
  std::optional<Time> low_since_;
  double lost_after_s_ = 0, lost_height_m_ = 0, sunk_m_ = 0;
  std::optional<Eigen::Vector2d> sent_;  // the last acceleration
  Time last_;
};

}  // namespace kestrel
