// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/comms/mavlink/autopilot.h"
#include "kestrel/comms/mavlink/connection.h"
#include "kestrel/comms/mavlink/target_profile.h"
#include "kestrel/core/base/latest_value.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/flight/onboard/flight_options.h"
#include "kestrel/flight/onboard/flight_vision.h"
#include "kestrel/flight/onboard/guided_flight.h"
#include "kestrel/flight/onboard/landing_watch.h"
#include "kestrel/flight/onboard/latency_statistics.h"
#include "kestrel/flight/onboard/recording_switch.h"
#include "kestrel/flight/onboard/repeated_image.h"
#include "kestrel/flight/onboard/target_sender.h"
#include "kestrel/flight/session/live_events.h"
#include "kestrel/flight/session/live_source.h"
#include "kestrel/flight/session/observation_sink.h"
#include "kestrel/io/recording/truth_rows.h"

namespace kestrel {

// How a flight ended.
enum class FlightEnd {
  kStopped,      // by the user
  kLanded,       // disarmed after it had flown
  kSourceEnded,  // a recording, to its end
  kFailed,       // camera or autopilot are gone for good
};

// What a flight is made of; all outlive the program. Null where there is none.
struct FlightParts {
  LiveSource* source = nullptr;
  FlightVision* vision = nullptr;
  Connection* connection = nullptr;
  Autopilot* autopilot = nullptr;  // on the connection
  RecordingSwitch* recording = nullptr;
  ObservationSink* sink = nullptr;
  bool guides = false;                 // flies by set-points when the pilot gives the mode
  bool source_has_poses = false;       // then those of the autopilot are not used
  std::optional<LinkProfile> profile;  // nothing: by the heartbeat
  // Of the pattern when a frame was taken, where a simulation knows it.
  std::function<std::optional<TruePattern>(const Frame&)> truth;
  double pattern_size_m = 1;  // its outer diameter
};

// The program that flies: capture, vision, link and output, each in a thread of its own. Between
// them are hand-overs that nobody waits at: frames that are late are dropped, the newest track and
// the newest pose count.
class FlightProgram {
 public:
  // 'tracker': of the vision's track. 'say': a line for the user, by any thread. Throws InputError
  // when the options are not valid.
  FlightProgram(const FlightOptions& options, const TargetTrackerOptions& tracker,
                const FlightParts& parts, std::function<void(const std::string&)> say);

  // Flies until it has landed, the source ends or 'is_stopped', which is asked ten times a second.
  // Once only.
  FlightEnd Run(const std::function<bool()>& is_stopped);

  // One line of how things are now. By any thread.
  std::string State() const;
  // The latency of each step, what was dropped and what was sent; a few lines. After the flight.
  std::string Summary() const;

  // A pose of the autopilot, on the local clock: what its listener gets. By the thread that Run
  // lets the connection receive in.
  void TakeAutopilotPose(const PoseSample& pose);

 private:
  // The steps whose latency is measured.
  enum Step { kArrival, kVision, kDetection, kMessage, kSetPoint };

  void Capture();
  void See();
  void Communicate();
  void WriteResults();

  bool IsFrozen(const Frame& frame);
  void WarnOnce();
  void Take(Event event);
  void TakePose(const PoseSample& pose);
  void TellTarget(Time now);
  void WatchFlight(Time now);
  void End(FlightEnd end);
  FlightReport ReportNow() const;
  std::shared_ptr<FlightRecorder> Recorder() const;  // null: nothing is recorded

  FlightOptions options_;
  FlightParts parts_;
  std::function<void(const std::string&)> say_;
  LiveEvents events_;
  LatestValue<TrackSnapshot> track_;
  LatestValue<PoseSample> source_pose_;
  PoseHistory poses_;  // the link's
  LatencyStatistics latency_;
  std::once_flag ended_;
  std::atomic<bool> is_over_{false};
  FlightEnd end_ = FlightEnd::kStopped;  // once it is over

  // Of the link's thread.
  std::optional<TargetSender> sender_;
  std::optional<GuidedFlight> guided_;
  LandingWatch landing_;
  Time heard_;  // the autopilot, the last time
  std::optional<PoseSample> newest_pose_;

  // Of the vision's thread.
  RepeatedImage repeated_image_;
  bool was_warned_ = false;

  std::atomic<int> repeated_frames_{0}, frames_{0}, detections_{0}, messages_{0};
  std::atomic<TargetPhase> phase_{TargetPhase::kSearching};
  std::atomic<GuidancePhase> guidance_phase_{GuidancePhase::kIdle};
  std::atomic<int> set_points_{0};
  std::atomic<bool> is_autopilot_here_{false}, is_landing_{false};
  std::atomic<double> height_m_{0};
};

}  // namespace kestrel
