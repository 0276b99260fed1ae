// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "kestrel/comms/mavlink/autopilot.h"
#include "kestrel/comms/mavlink/connection.h"
#include "kestrel/comms/mavlink/gimbal_manager.h"
#include "kestrel/comms/mavlink/packet.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/core/poses/gimbal_history.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/flight/guidance/gimbal_pointing.h"
#include "kestrel/flight/onboard/flight_options.h"
#include "kestrel/flight/onboard/send_schedule.h"
#include "kestrel/flight/session/track_snapshot.h"
#include "kestrel/vision/tracking/target_tracker.h"

namespace kestrel {

// Returns what the camera of a calibration with a gimbal sees of a pad.
GimbalView GimbalViewOf(const CameraCalibration& calibration, const PadInSight& pad);

// Points the camera's gimbal at the target while the UAV flies, and informs the user. A pad is
// searched for; without one, the gimbal is left alone until something is marked, and stays where it
// is when that is lost. A gimbal that somebody else moves is left alone until control is handed
// back, the pilot gives the guided mode anew, something else is marked, or the user requests it.
// Used by the link's thread only.
class PointedGimbal {
 public:
  // 'calibration' has a gimbal. 'pad': nothing: the target is what a person marks. 'tracker':
  // options of the predicted track. 'report': receives lines for the user. The pointers must
  // outlive this.
  PointedGimbal(const FlightOptions& options, const CameraCalibration& calibration,
                const std::optional<PadInSight>& pad, const TargetTrackerOptions& tracker,
                Autopilot* autopilot, Connection* connection,
                std::function<void(const std::string&)> report);

  // Takes a packet of the link, and a report of the gimbal.
  void Handle(const mavlink::Packet& packet) { manager_.Handle(packet); }
  void TakeReport(const GimbalSample& report) { report_sample_ = report; }

  // Takes a gimbal that was left alone, as the user requests.
  void Resume();

  // Sends what is due at 'now'.
  void Point(Time now, const TrackSnapshot& track, const PoseHistory& poses);

 private:
  // Whether the gimbal follows.
  struct Following {
    Time since{};                   // it was near its aim, or had come nearer
    double progress = 0;            // since then towards the aim, rad
    Eigen::Vector3d axis{1, 0, 0};  // of the newest report
  };

  void WatchFlight(int mark);
  bool IsFlying() const;
  void ReportControl(Time now);
  std::optional<Eigen::Vector3d> Target(Time then, const TrackSnapshot& track);
  void WatchFollowing(Time now, const GimbalAngles& aim, double heading);
  void Notify(std::uint8_t severity, const std::string& text);

  FlightOptions options_;
  bool has_pad_;
  RigidTransform body_from_pivot_;
  TurnNoise noise_;
  Autopilot& autopilot_;
  std::function<void(const std::string&)> report_;
  GimbalManager manager_;
  GimbalPointing pointing_;
  SendSchedule schedule_;
  std::optional<TargetState> sighting_;  // the newest one
  std::optional<GimbalSample> report_sample_;
  std::optional<Following> following_;
  GimbalManager::Control reported_ = GimbalManager::Control::kNone;
  std::optional<Time> requested_;  // since then control is awaited
  bool was_guided_ = false;
  int mark_ = 0;  // number of the newest mark
};

}  // namespace kestrel
