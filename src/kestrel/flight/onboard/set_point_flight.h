// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "kestrel/comms/guard/flight_guard.h"
#include "kestrel/comms/mavlink/autopilot.h"
#include "kestrel/comms/mavlink/connection.h"
#include "kestrel/comms/mavlink/global_position.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/flight/onboard/flight_options.h"
#include "kestrel/flight/onboard/guided_flight.h"
#include "kestrel/flight/onboard/no_position_flight.h"
#include "kestrel/flight/onboard/pad_position.h"
#include "kestrel/flight/session/track_snapshot.h"

namespace kestrel {

// Kinds of flight by set-points, and what they need.
struct SetPointTask {
  GuidanceMaker guidance = {};                       // by the autopilot's position; null: not
  std::optional<RelativeJob> without_position = {};  // by the pad alone, or as a reserve
  bool sends_pad_position = false;                   // the autopilot's position is the pad's
  std::optional<GlobalPosition> box = {};            // where objects are delivered
  std::optional<GlobalPosition> place = {};          // where a job goes that has no object
  bool is_in_its_frame = true;                       // see GuidedFlight
};

// Flies the UAV by set-points, by the autopilot's position or by the pad alone, and gives each of
// the two, and the position by the pad, what the autopilot reports. Used by the link's thread only.
class SetPointFlight {
 public:
  // 'tracker': options of the predicted track. 'report': receives lines for the user. Throws
  // InputError when the options are not valid.
  SetPointFlight(const FlightOptions& options, const TargetTrackerOptions& tracker,
                 const SetPointTask& task, Autopilot* autopilot, Connection* connection,
                 const std::function<void(const std::string&)>& report);

  // See NoPositionFlight and PadPosition.
  void TakeAttitude(const PoseSample& attitude);
  void TakeAcceleration(Time time, const Eigen::Vector3d& acceleration);
  void TakeClimb(double climb_mps);
  // Takes a pose of the autopilot; false when its position is a guess.
  bool TakePose(const PoseSample& pose, Time now);

  // Sends what is due at 'now'; true when it was the first set-point of a new frame.
  bool Fly(Time now, const TrackSnapshot& track, const PoseHistory& poses);

  // True: the pad alone counts, the autopilot has no position.
  bool is_without_position() const { return no_position_ && no_position_->is_in_charge(); }
  // The flight by position where that is in charge; else null.
  GuidedFlight* by_position() { return guided_ && !is_without_position() ? &*guided_ : nullptr; }
  // The flight by the pad alone where that is in charge; else null.
  const NoPositionFlight* by_pad() const {
    return is_without_position() ? &*no_position_ : nullptr;
  }

  // Task of the guard if this is the last sign of life.
  GuardTask TaskOfGuard(Time now) const;

  // These are about the one that is in charge.
  GuidancePhase phase() const;
  bool is_flying() const;  // the UAV flies by set-points
  int set_points() const;  // sent
  // Angle of the nose off the wanted heading, rad, until contact; nothing: any heading will do, or
  // the pad's is not known.
  std::optional<double> heading_error() const;
  // Why guidance gave up; empty: it flies, the pilot has taken over since, or it has not begun.
  std::string gave_up() const;

 private:
  GuardTask TaskOf(const GuidedFlight& guided, Time now) const;
  GuardTask TaskOf(const NoPositionFlight& flight) const;

  Autopilot& autopilot_;
  std::optional<PadPosition> pad_position_;
  std::optional<GuidedFlight> guided_;
  std::optional<NoPositionFlight> no_position_;  // instead of guided_, or its reserve
};

}  // namespace kestrel
