// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include <opencv2/core.hpp>

#include "kestrel/comms/mavlink/autopilot.h"
#include "kestrel/comms/mavlink/camera_component.h"
#include "kestrel/comms/mavlink/connection.h"
#include "kestrel/comms/mavlink/packet_writer.h"
#include "kestrel/core/base/bounded_queue.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/flight/onboard/camera_stream.h"
#include "kestrel/flight/onboard/flight_options.h"
#include "kestrel/flight/onboard/send_schedule.h"
#include "kestrel/flight/session/track_snapshot.h"
#include "kestrel/flight/session/vision.h"

namespace kestrel {

// The camera for ground stations: what they mark reaches the vision, and what is followed reaches
// them, and others as FOLLOW_TARGET (fly.messages.sends_follow_target). A mark counts in the
// picture that the person saw, and is answered when the vision has taken it. Used by the link's
// thread only, but for ApplyMarks.
class TrackingCamera {
 public:
  // 'stream': in which the ground stations mark. 'report': receives lines for the user. The
  // pointers must outlive this. Throws InputError when the camera has the id of this program.
  TrackingCamera(const FlightOptions& options, const CameraCalibration& calibration,
                 const CameraStream& stream, Autopilot* autopilot, Connection* connection,
                 std::function<void(const std::string&)> report);

  // Takes a packet of the link.
  void Handle(const mavlink::Packet& packet, Time received);
  // Sends what is due at 'now'.
  void Tick(Time now, const TrackSnapshot& track, const PoseHistory& poses);

  // Passes waiting marks to the vision. Called by the vision's thread, before a frame.
  void ApplyMarks(Time now, Vision* vision);

 private:
  struct Mark {
    int request = 0;
    Time received;
    Time shown;                        // the newest picture at this time is the marked one
    std::optional<cv::Rect2d> box_px;  // nothing: the following ends
  };
  struct Outcome {
    int request = 0;
    std::string refusal;
  };
  static constexpr std::size_t kMostMarks = 8;  // that wait; more than the ground stations

  CameraTracking TrackingAt(Time now, const TrackSnapshot& track, const PoseHistory& poses);
  CameraTracking::State StateAt(Time now, const TrackSnapshot& track);
  std::optional<TargetState> TargetAt(Time now, const TrackSnapshot& track,
                                      const PoseHistory& poses) const;
  void SendFollowTarget(Time now, const TargetState& target);

  FlightOptions options_;
  cv::Size size_px_;
  std::function<Duration()> delay_;
  Autopilot& autopilot_;
  Connection& connection_;
  std::function<void(const std::string&)> report_;
  mavlink::PacketWriter writer_;  // of the camera component
  CameraComponent component_;
  SendSchedule follow_target_;
  Time due_{};                // when something may have to be sent next
  std::optional<Time> lost_;  // since then
  BoundedQueue<Mark> marks_{kMostMarks};
  BoundedQueue<Outcome> outcomes_{kMostMarks};
};

}  // namespace kestrel
