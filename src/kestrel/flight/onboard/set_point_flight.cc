// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/set_point_flight.h"

namespace kestrel {

SetPointFlight::SetPointFlight(const FlightOptions& options, const TargetTrackerOptions& tracker,
                               const SetPointTask& task, Autopilot* autopilot,
                               Connection* connection,
                               const std::function<void(const std::string&)>& report)
    : autopilot_(*autopilot) {
  if (task.sends_pad_position) {
    pad_position_.emplace(ParseGlobalPosition(options.pad_origin), autopilot, connection, report);
  }
  if (task.without_position) {
    no_position_.emplace(options, *task.without_position, autopilot, connection, report);
  }
  if (!task.guidance || is_without_position()) return;
  guided_.emplace(options, tracker, task.guidance, task.is_in_its_frame, autopilot, connection,
                  report);
  if (task.sends_pad_position) guided_->set_position_by_pad();
  if (task.box) guided_->set_box(*task.box);
  if (task.place) guided_->set_place(*task.place);
}

void SetPointFlight::TakeAttitude(const PoseSample& attitude) {
  if (pad_position_) pad_position_->TakeAttitude(attitude);
  if (no_position_) no_position_->TakeAttitude(attitude);
}

void SetPointFlight::TakeAcceleration(Time time, const Eigen::Vector3d& acceleration) {
  if (pad_position_) pad_position_->TakeAcceleration(time, acceleration);
  if (no_position_) no_position_->TakeAcceleration(time, acceleration);
}

void SetPointFlight::TakeClimb(double climb_mps) {
  if (no_position_) no_position_->TakeClimb(climb_mps);
}

// A position that comes from the pad ends with its sight: the autopilot's own guess goes on for
// seconds. Where it has none, what it sends is a guess from the first.
bool SetPointFlight::TakePose(const PoseSample& pose, Time now) {
  if (is_without_position()) {
    no_position_->TakePose(pose);
    return false;
  }
  return !pad_position_ || pad_position_->is_known(now);
}

bool SetPointFlight::Fly(Time now, const TrackSnapshot& track, const PoseHistory& poses) {
  if (pad_position_) pad_position_->Send(now, track);
  bool is_first = false;
  if (no_position_) {
    if (guided_) no_position_->WatchPosition(now, guided_->is_flying() && !guided_->is_at_deck());
    is_first = no_position_->Fly(now, track);
  }
  if (GuidedFlight* const guided = by_position()) is_first = guided->Fly(now, track, poses);
  return is_first;
}

GuardTask SetPointFlight::TaskOfGuard(Time now) const {
  if (is_without_position()) return TaskOf(*no_position_);
  return guided_ ? TaskOf(*guided_, now) : GuardTask::kNothing;
}

GuardTask SetPointFlight::TaskOf(const GuidedFlight& guided, Time now) const {
  if (guided.is_at_deck() && autopilot_.is_guided_mode()) return GuardTask::kLand;
  if (!guided.is_flying()) return GuardTask::kNothing;
  const bool is_lost = !guided.has_pose() && !autopilot_.is_position_good(now).value_or(true);
  return guided.is_position_by_pad() || is_lost ? GuardTask::kLower : GuardTask::kStop;
}

GuardTask SetPointFlight::TaskOf(const NoPositionFlight& flight) const {
  if (flight.is_handing_over() && autopilot_.is_guided_mode()) return GuardTask::kLower;
  if (!IsGuidedByLeanMode(autopilot_.kind(), autopilot_.custom_mode())) return GuardTask::kNothing;
  if (flight.is_at_deck()) return GuardTask::kLand;
  const bool is_its_own = flight.is_flying() || flight.has_given_up();
  return is_its_own ? GuardTask::kLower : GuardTask::kNothing;
}

GuidancePhase SetPointFlight::phase() const {
  if (is_without_position()) return no_position_->phase();
  return guided_ ? guided_->phase() : GuidancePhase::kIdle;
}

bool SetPointFlight::is_flying() const {
  if (is_without_position()) return no_position_->is_flying();
  return guided_ && guided_->is_flying();
}

int SetPointFlight::set_points() const {
  if (is_without_position()) return no_position_->set_points();
  return guided_ ? guided_->set_points() : 0;
}

std::optional<double> SetPointFlight::heading_error() const {
  if (is_without_position()) {
    const bool is_coming_down = no_position_->phase() == GuidancePhase::kCommit;
    return is_flying() || is_coming_down ? no_position_->heading_error() : std::nullopt;
  }
  return is_flying() ? guided_->heading_error() : std::nullopt;
}

std::string SetPointFlight::gave_up() const {
  if (is_without_position()) return no_position_->gave_up();
  return guided_ ? guided_->gave_up() : "";
}

}  // namespace kestrel
