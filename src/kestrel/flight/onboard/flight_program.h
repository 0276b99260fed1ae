// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/comms/mavlink/autopilot.h"
#include "kestrel/comms/mavlink/connection.h"
#include "kestrel/comms/mavlink/target_profile.h"
#include "kestrel/comms/team/team_goal.h"
#include "kestrel/core/base/latest_value.h"
#include "kestrel/core/base/service_manager.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/flight/onboard/camera_stream.h"
#include "kestrel/flight/onboard/exposure_drive.h"
#include "kestrel/flight/onboard/flight_options.h"
#include "kestrel/flight/onboard/guard_watch.h"
#include "kestrel/flight/onboard/landing_watch.h"
#include "kestrel/flight/onboard/latency_statistics.h"
#include "kestrel/flight/onboard/open_live_source.h"
#include "kestrel/flight/onboard/pointed_gimbal.h"
#include "kestrel/flight/onboard/recording_switch.h"
#include "kestrel/flight/onboard/set_point_flight.h"
#include "kestrel/flight/onboard/sign_of_life.h"
#include "kestrel/flight/onboard/take_off_ground.h"
#include "kestrel/flight/onboard/target_sender.h"
#include "kestrel/flight/onboard/tracking_camera.h"
#include "kestrel/flight/session/flight_report.h"
#include "kestrel/flight/session/live_events.h"
#include "kestrel/flight/session/live_source.h"
#include "kestrel/flight/session/observation_sink.h"
#include "kestrel/flight/session/track_snapshot.h"
#include "kestrel/flight/session/vision.h"
#include "kestrel/io/recording/euroc/truth_rows.h"
#include "kestrel/vision/pipeline/repeated_image.h"
#include "kestrel/vision/pipeline/sought_object.h"

namespace kestrel {

// The parts of a flight; all outlive the program. Null where there is none.
struct FlightParts {
  LiveSource* source = nullptr;
  std::vector<LateCamera> late = {};  // cameras of the source
  Vision* vision = nullptr;
  ExposureDrive* exposure = nullptr;  // keeps the target's white right
  Connection* connection = nullptr;
  Autopilot* autopilot = nullptr;  // on the connection
  GuardLink* guard = nullptr;      // below the connection
  RecordingSwitch* recording = nullptr;
  ObservationSink* tables = nullptr;
  ObservationSink* sink = nullptr;
  const CameraCalibration* pointed = nullptr;  // with the gimbal to point; null: none is pointed
  // The camera in whose images ground stations mark what is followed; null: there is none.
  const CameraCalibration* tracking = nullptr;
  const CameraStream* stream = nullptr;  // in which they do so; null: the source's own
  GuidanceMaker guidance = {};  // flies by set-points when the pilot gives the mode; null: does not
  std::optional<GlobalPosition> box = {};            // where objects are delivered
  std::optional<GlobalPosition> place = {};          // that the UAV goes to
  bool sends_pad_position = false;                   // see SessionOptions
  std::optional<RelativeJob> without_position = {};  // see SessionOptions
  bool source_has_poses = false;                     // the autopilot's poses are then not used
  bool sees_repeated = false;                        // processes images that equal the one before
  std::size_t cameras = 1;
  std::optional<LinkProfile> profile;  // nothing: chosen by the heartbeat
  // Returns the true pattern at the time of a frame, in a simulation that knows it.
  std::function<std::optional<TruePattern>(const Frame&)> truth;
  // Returns the true offset of the touch-down, in a simulation that knows it, see FlightEnd.
  std::function<std::optional<double>()> true_offset_m;
};

// The program that flies: capture, vision and link have a thread each. Nobody waits at the
// hand-overs between them: late frames are dropped, and only the newest track and the newest pose
// count.
class FlightProgram {
 public:
  // 'report': receives lines for the user, from any thread. Throws InputError when the options are
  // not valid.
  FlightProgram(const FlightOptions& options, const FlightParts& parts,
                std::function<void(const std::string&)> report);

  // Flies until the UAV has landed, the source ends or 'is_stopped', which is called ten times a
  // second, returns true. The end is also reported to the user, the ground station and the sink.
  // Throws what 'is_stopped' throws, once the threads have ended. Call it once only.
  FlightEnd Run(const std::function<bool()>& is_stopped);

  // Returns the present state in one line. Called by any thread.
  std::string State() const;
  // Returns latencies of each step and the counts of what was dropped and sent; a few lines, after
  // the flight.
  std::string Summary() const;

  // Calls 'action' between two frames: the vision waits for it. By any thread.
  void BetweenFrames(const std::function<void()>& action);

  // Points the gimbal again that was left alone. Throws InputError where none is pointed. Called by
  // any thread.
  void ResumePointing();
  // Orders guidance to fly to the mark with this number, from when the pilot has given the mode; 0:
  // to stand still. Called by any thread.
  void Order(int mark);

  // Takes what the team wants of this UAV, and returns what it does. Called by any thread.
  void Take(const TeamGoal& goal);
  FlightToObjects ToObjects() const;

  // Returns the present state. Called by any thread.
  FlightReport Report() const;

  // Takes a pose of the autopilot, on the local clock, from its listener. Called by the thread in
  // which Run lets the connection receive.
  void TakeAutopilotPose(const PoseSample& pose);
  // Takes an attitude of the autopilot, as above.
  void TakeAutopilotAttitude(const PoseSample& attitude);
  // Takes what the autopilot's accelerometer measures, as above.
  void TakeAutopilotAcceleration(Time time, const Eigen::Vector3d& acceleration);
  // Takes how fast the UAV climbs (m/s), as above.
  void TakeAutopilotClimb(double climb_mps);
  // Takes a report of the gimbal by the autopilot, as above.
  void TakeAutopilotGimbal(const GimbalSample& report);
  // Takes a report of the camera's zoom, in the same way.
  void TakeZoom(const ZoomSample& report);

 private:
  // The steps whose latency is measured.
  enum Step { kArrival, kVision, kDetection, kMessage, kSetPoint };

  void Watch(const std::function<bool()>& is_stopped);
  void NotifyServiceManager(Time now);
  void Capture();
  void See();
  void AssignObject();
  TrackSnapshot See(const Frame& frame);
  void Communicate();

  bool IsFrozen(const Frame& frame);
  void WarnOnce();
  void ReportCameras();
  void Take(Event event);
  void TakePose(const PoseSample& pose);
  void TakeGimbal(const GimbalSample& report);
  void Point(Time now);
  void SendTarget(Time now);
  void Fly(Time now, const TrackSnapshot& track);
  bool flies_by_set_points() const { return parts_.guidance || parts_.without_position; }
  void WatchFlight(Time now);
  LandingWatchInput LandingInput(Time now);
  void WatchGround(const LandingWatchInput& input);
  void ShowAutopilot(Time now);
  void ReportWhatItWaitsFor(Time now);
  std::string SourceTrouble() const;
  Duration VideoDelay() const;
  void End(const FlightEnd& end);
  void EndByLanding(FlightEnd end);
  void ReportEnd();
  std::shared_ptr<FlightRecorder> Recorder() const;  // null: nothing is recorded

  FlightOptions options_;
  FlightParts parts_;
  const Time began_ = Now();
  std::function<void(const std::string&)> report_;
  LiveEvents events_;
  LatestValue<TrackSnapshot> track_;
  mutable std::mutex other_tag_mutex_;
  std::optional<OtherTag> other_tag_;  // instead of the target, for the state in words
  LatestValue<PoseSample> source_pose_;
  PoseHistory poses_;  // from the link
  LatencyStatistics latency_;
  std::atomic<Duration> arrival_{Duration::zero()};  // how late the newest frame came
  ServiceManager service_manager_;
  SignOfLife capture_life_, vision_life_, link_life_;
  std::once_flag ended_;
  std::atomic<bool> is_over_{false};
  FlightEnd end_;  // valid once the flight is over

  // Used by the link's thread only.
  std::optional<PadInSight> pad_;
  TargetTrackerOptions tracker_;
  std::optional<TargetSender> sender_;  // nothing: there is nothing to land on
  std::optional<SetPointFlight> set_point_flight_;
  bool awaits_poses_ = true;  // for the frames
  std::optional<PointedGimbal> gimbal_;
  std::atomic<bool> resumes_pointing_{false};  // set by any thread
  std::optional<TrackingCamera> camera_;       // its marks are applied by the vision's thread
  TurnNoise noise_;                            // how the predicted track may turn
  std::optional<GuardWatch> guard_;
  LandingWatch landing_;
  TakeOffGround ground_;
  Time landing_due_{};   // when the landing is looked at next
  std::string gave_up_;  // why guidance gave up last; empty: it flies, or has not
  Time heard_;           // the newest time at which the autopilot was heard
  bool was_heard_ = false;
  Time wait_due_{};  // when it is next looked for the reason of the autopilot's silence

  mutable std::mutex team_mutex_;
  std::optional<TeamInFlight> team_;        // until guidance has it; guarded by team_mutex_
  FlightToObjects to_objects_;              // the same
  std::optional<AssignedObject> assigned_;  // the same, until the vision has it

  std::mutex vision_mutex_;  // held while the vision works

  // Used by the vision's thread only.
  RepeatedImage repeated_image_;
  bool was_warned_ = false;
  std::size_t reported_camera_events_ = 0;

  std::atomic<int> repeated_frames_{0}, frames_{0}, detections_{0}, messages_{0};
  std::atomic<TargetPhase> phase_{TargetPhase::kSearching};
  std::atomic<int> ended_mark_{0};        // see Guidance::ended
  std::atomic<double> ground_zero_m_{0};  // see Vision::SetGroundZero
  std::atomic<GuidancePhase> guidance_phase_{GuidancePhase::kIdle};
  std::atomic<int> set_points_{0};
  std::atomic<int> orders_{0};
  std::atomic<FollowOrder> order_{FollowOrder()};
  mutable std::mutex autopilot_mutex_;
  AutopilotState autopilot_state_;  // guarded by autopilot_mutex_
  std::atomic<double> height_m_{0};
};

}  // namespace kestrel
