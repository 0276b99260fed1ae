// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/comms/mavlink/autopilot.h"
#include "kestrel/comms/mavlink/connection.h"
#include "kestrel/comms/mavlink/gimbal_manager.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/flight/doctor/finding.h"
#include "kestrel/flight/doctor/observations.h"
#include "kestrel/flight/session/live_events.h"
#include "kestrel/flight/session/live_source.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"

namespace kestrel {

// Input of an examination; all outlive it. Null where there is none.
struct ExaminationParts {
  LiveSource* source = nullptr;
  CameraCalibration calibration = {};           // calibration of the source
  std::vector<CameraCalibration> further = {};  // of its further cameras
  Connection* connection = nullptr;
  Autopilot* autopilot = nullptr;  // on the connection
};

// Watches camera and autopilot for some seconds: capture, vision and link have a thread each, as in
// a flight, but nothing is sent that would move the UAV.
class Examination {
 public:
  // Throws InputError when options or calibration are not valid.
  Examination(const LandingPipelineOptions& options, const LiveEventsOptions& events,
              const ExaminationParts& parts);

  // Takes a pose of the autopilot, on the local clock, from its listener. Called by the thread that
  // calls Run.
  void TakePose(const PoseSample& pose);
  void TakeGimbal(const GimbalSample& report);
  void TakeZoom(const ZoomSample& report);
  // Takes an event from the autopilot's listener. Called by the same thread.
  void TakeEvent(const AutopilotEvent& event);

  // Watches for 'duration', or until 'is_stopped', and adds the results to 'observations'. Call it
  // once only.
  void Run(Duration duration, const std::function<bool()>& is_stopped,
           DoctorObservations* observations);

 private:
  void Capture();
  void See();
  void Communicate(Time now);
  void Look(const Frame& frame);
  void TakePacket(const mavlink::Packet& packet, Time received);
  void WantParameters();
  // A camera of the source.
  struct Eye {
    CameraCalibration calibration;
    // It has no mount: what it finds does not depend on the attitude.
    LandingPipeline pipeline;

    // Used by the capture thread.
    std::vector<FrameSample> frames = {};
    int width_px = 0;
    int height_px = 0;
    // Used by the vision thread.
    std::vector<ImageQuality> qualities = {};
    std::vector<PatternSample> patterns = {};
    std::optional<OtherTag> other_tag = {};
    std::vector<double> detect_s = {};
    std::vector<double> latency_s = {};
  };

  void Summarize(Time start, Time end, DoctorObservations* observations) const;
  void SummarizeCamera(const Eye& eye, double duration_s, CameraSetup* setup) const;
  void SummarizeVision(const Eye& eye, VisionObservations* vision) const;
  void SummarizeLink(Time end, LinkObservations* link) const;
  void SummarizeGimbal(GimbalObservations* gimbal) const;
  void SummarizeParameters(ParameterValues* values) const;

  ExaminationParts parts_;
  LiveEvents events_;
  std::vector<Eye> eyes_;  // none without a source
  PoseHistory poses_;      // used by the vision thread
  std::atomic<bool> is_over_{false};

  // Used by the link's thread.
  bool requested_parameters_ = false;
  int heartbeats_ = 0;
  bool hears_signed_ = false;
  bool is_one_way_ = false;  // TIMESYNC is not answered
  int attitudes_ = 0;
  int gimbal_reports_ = 0;
  int zoom_reports_ = 0;
  std::optional<double> view_rad_;        // the newest of these
  std::optional<GimbalManager> manager_;  // reads the camera's gimbal; it takes no control
  std::vector<GimbalObservation> gimbal_;
  std::optional<Eigen::Quaterniond> world_from_body_;  // by the newest pose
  int positions_ = 0;
  std::optional<Time> heard_;      // time of the first message
  std::optional<Time> listening_;  // time since which the streams are counted
  Time attitude_time_;
  Time position_time_;
  std::vector<std::string> reported_;
};

// Returns the part of a detection that the checks use; the caller adds its time and the UAV's pose.
PatternSample PatternSampleOf(const TargetDetection& detection);

// Runs all checks, in the order in which a set-up is put right. Those of a further camera have its
// name before theirs.
std::vector<Finding> Check(const DoctorObservations& observations);

}  // namespace kestrel
