// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>

#include <Eigen/Core>

#include "kestrel/comms/mavlink/autopilot.h"
#include "kestrel/comms/mavlink/connection.h"
#include "kestrel/comms/mavlink/target_profile.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/flight/onboard/flight_options.h"
#include "kestrel/flight/onboard/send_schedule.h"
#include "kestrel/flight/onboard/target_reporter.h"
#include "kestrel/vision/tracking/target_tracker.h"

namespace kestrel {

// Time from sending to the autopilot's use: as configured, or half of the fastest round trip.
Duration LinkDelay(const FlightOptions& options, const Autopilot& autopilot);

// Reports the target to the autopilot steadily, and its state to the user. Used by the link's
// thread only.
class TargetSender {
 public:
  // 'profile': nothing: chosen by the heartbeat. 'size_m': diameter of the pattern.
  // 'sight_range_m': from which the camera sees it at most, 0: not known. 'is_guided': the
  // autopilot is to land by set-points, not by the targets. 'report': receives lines for the user.
  TargetSender(const FlightOptions& options, const TargetTrackerOptions& tracker,
               std::optional<LinkProfile> profile, double size_m, double sight_range_m,
               bool is_guided, Autopilot* autopilot, Connection* connection,
               std::function<void(const std::string&)> report);

  // Sends what is due at 'now'; true when it was the first message of a new frame.
  bool Send(Time now, const TrackSnapshot& track, const PoseHistory& poses);

  // See TargetReporter.
  void set_may_stand(bool may_stand) { reporter_.set_may_stand(may_stand); }

  TargetPhase phase() const { return reporter_.phase(); }
  double height_m() const { return reporter_.height_m(); }  // how far the UAV is above the target
  int messages() const { return messages_; }                // number of targets sent

 private:
  void WantParameters();
  Duration UntilUse() const;
  Eigen::Vector3d CameraOfArduPilot() const;
  void WarnOfSpeed(const Eigen::Vector3d& velocity);
  void ReportPhase();
  void ReportLanding();

  FlightOptions options_;
  std::optional<LinkProfile> profile_;
  double size_m_;
  double sight_range_m_;
  bool is_guided_;
  Autopilot& autopilot_;
  Connection* connection_;
  std::function<void(const std::string&)> report_;
  TargetReporter reporter_;
  SendSchedule schedule_;
  Time reported_frame_;  // the newest frame used for a message
  TargetPhase reported_phase_ = TargetPhase::kSearching;
  int moving_messages_ = 0;  // in a row whose target moved
  bool is_warned_ = false;
  bool was_landing_ = false;
  bool requested_parameters_ = false;
  int messages_ = 0;
};

}  // namespace kestrel
