// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "kestrel/comms/mavlink/autopilot.h"
#include "kestrel/comms/mavlink/connection.h"
#include "kestrel/comms/mavlink/global_position.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/flight/onboard/pad_motion_watch.h"
#include "kestrel/flight/onboard/pad_place.h"
#include "kestrel/flight/session/track_snapshot.h"

namespace kestrel {

// Sends the UAV's place over a pad that stands to the autopilot, as its external navigation: one
// ODOMETRY for each frame that shows the pad. Used by the link's thread only.
class PadPosition {
 public:
  // 'origin': of the autopilot's frame, if it has none; nothing: none is set. 'report': receives
  // lines for the user.
  PadPosition(std::optional<GlobalPosition> origin, Autopilot* autopilot, Connection* connection,
              std::function<void(const std::string&)> report);

  // Takes the autopilot's attitude, on the local clock; its place does not count.
  void TakeAttitude(const PoseSample& sample);
  // Takes what its accelerometer measures, see AutopilotListener.
  void TakeAcceleration(Time time, const Eigen::Vector3d& acceleration);

  // Sends what is due at 'now': the place, and once the origin of the autopilot's frame, if it has
  // none.
  void Send(Time now, const TrackSnapshot& track);

  // True while the autopilot's position is one of the pad: the pad was seen in the last second, and
  // stands, and the autopilot has found its estimate good since. PX4's is far off before (it is at
  // latitude 0 when it gets its origin), and an autopilot goes on for 5 to 8 s without the pad, and
  // drifts.
  bool is_known(Time now) const;

 private:
  void BeginWith(Time now);
  bool is_seen(Time now) const;
  void WantParameters();
  std::string WhyUnused(Time now) const;
  HeadingSource HeadingOfEstimator() const;
  void SendOrigin(Time now);
  void WatchPad(const ExternalPose& pose);
  void ReportState(Time now);
  void Notify(std::uint8_t severity, const std::string& text);

  std::optional<GlobalPosition> origin_;
  Autopilot& autopilot_;
  Connection* connection_;
  std::function<void(const std::string&)> report_;
  PoseHistory attitudes_;
  PadPlace place_;
  PadMotionWatch motion_;
  std::optional<Time> first_;   // when the first place was sent
  std::optional<Time> newest_;  // the newest sight that was taken
  std::optional<Time> known_;   // the newest one of a pad that stands
  std::optional<Time> heard_;   // when the autopilot was first here
  bool requested_parameters_ = false;
  bool is_origin_settled_ = false;
  bool was_checked_ = false;
  bool was_clock_missed_ = false;
  bool was_known_ = false;
  bool is_used_ = false;    // the estimate was good while the pad was seen
  bool is_moving_ = false;  // the pad, noticed in this flight
  bool is_turned_ = false;  // its heading has left the pad's
  std::uint8_t watched_resets_ = 0;
  int reported_resets_ = 0;
  int restarts_ = 0;  // how often the autopilot has begun anew
};

}  // namespace kestrel
