// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/calibration/mount/video_delay.h"
#include "kestrel/comms/mavlink/autopilot.h"
#include "kestrel/comms/mavlink/connection.h"
#include "kestrel/comms/mavlink/link_url.h"
#include "kestrel/comms/mavlink/target_profile.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/core/poses/gimbal_angles.h"
#include "kestrel/core/poses/gimbal_history.h"
#include "kestrel/flight/doctor/image_quality.h"
#include "kestrel/flight/doctor/parameter_values.h"
#include "kestrel/flight/session/live_source.h"
#include "kestrel/vision/pipeline/calibration_monitor.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"

// Input of the checks: what camera, autopilot and computer showed in some seconds. The checks are
// functions of these alone.
namespace kestrel {

// Intended use of the set-up, on which the checks depend.
struct DoctorUse {
  std::optional<LinkProfile> profile;  // nothing: chosen by the heartbeat
  bool guides = false;                 // Kestrel flies the UAV by set-points
  bool points = false;                 // and points the gimbal, if there is one
  std::optional<double> target_mps;    // speed of a target that moves; nothing: it stands
  double tilt_deg = 30;                // by which guidance may lean
  double sight_s = 0.5;                // so long it flies on near the deck without a sighting
  bool pad_position = false;           // the pad is the autopilot's position
  bool no_position = false;            // it has none, and is flown without
  bool has_reserve = false;            // it is flown without once its position is lost
  // False where the autopilot has no position by itself.
  bool has_position() const { return !pad_position && !no_position; }
  bool has_pad_origin = false;         // Kestrel sets the origin of its frame
  bool sends_distance = false;         // DISTANCE_SENSOR too
  double attitude_rate_hz = 100;       // requested from the autopilot
  double position_rate_hz = 50;        //
  std::optional<double> link_delay_s;  // as configured; nothing: by the round trip
  std::string record;                  // folder of the recording; empty: none
  double sight_range_m = 0;            // from which the camera sees the pattern; 0: not known
  bool follows = false;                // Kestrel is a camera in which people mark what it follows
};

// The times of a frame.
struct FrameSample {
  Time stamp;    // when its light was collected, according to the source
  Time arrival;  // both on the clock of Now()
};

struct CameraObservations {
  std::string open_error;       // why it could not be opened; empty: it could be
  bool has_other_size = false;  // the reason was the size of its images
  bool is_on_ground = false;    // the autopilot reports that the UAV stands
  std::string error;            // its last error
  double duration_s = 0;        // time for which it was watched
  int width_px = 0;             // width of its images; 0: there were none
  int height_px = 0;
  std::vector<FrameSample> frames;      // in the order in which they came
  std::vector<ImageQuality> qualities;  // quality of each examined frame
  CaptureCounters counters;             // of all cameras together
  bool comes_late = false;              // over a network
  std::optional<ClockEstimate> delay;   // how late the images come, by their turns
};

// The pattern in one frame, found without mount and attitude.
struct PatternSample {
  Time time;  // time of the frame on the navigation's clock
  RigidTransform camera_from_target;
  std::optional<RigidTransform> mirror_camera_from_target;
  double ring_px = 0;        // smaller diameter of the ring
  double misfit_px = 0;      // distance of the edges from where pose and lens place them
  bool contradicts = false;  // the calibration cannot explain the detection
  std::optional<RigidTransform> world_from_body;  // according to the autopilot
};

struct VisionObservations {
  int frames = 0;          // processed
  int dropped_frames = 0;  // while the frame before was still processed
  std::vector<PatternSample> patterns;
  std::optional<OtherTag> other_tag = {};          // seen where the pattern never was
  std::optional<FocalFactor> focal;                // their estimate of the focal length
  std::optional<FocalFactor> focal_contradiction;  // the same, where it contradicts the calibration
  double detect_s = 0;                             // median and
  double detect_p90_s = 0;
  double latency_s = 0;  // median, from the frame's exposure to the detection
};

struct LinkObservations {
  bool isrequested = false;  // an autopilot was given at all
  std::string open_error;    // why the line could not be opened; empty: it could be
  std::string silence;       // why no autopilot is heard, see WhySilent; empty: it is heard
  LinkScheme scheme = LinkScheme::kUdpIn;
  int baud = 0;               // baud rate of a serial line
  bool is_signed = false;     // this side signs its packets
  bool hears_signed = false;  // the other side signs its packets
  ConnectionCounters counters;
  bool is_heard = false;  // a heartbeat came before the end
  AutopilotKind kind = AutopilotKind::kUnknown;
  std::optional<AutopilotVersion> version;
  std::optional<std::uint8_t> vehicle_type;  // MAV_TYPE
  std::string mode;
  bool is_armed = false;
  int heartbeats = 0;
  double listened_s = 0;  // time for which the streams were counted
  int attitudes = 0;      // messages in that time
  int positions = 0;
  std::optional<int> gimbal_reports;  // in that time; nothing: the camera is on no gimbal
  int zoom_reports = 0;               // in that time
  std::optional<double> view_rad;     // the newest one of these
  double attitude_age_s = 0;          // age of the newest attitude at the end
  double position_age_s = 0;
  bool has_origin = false;                // of the autopilot's local frame
  std::optional<bool> has_good_position;  // according to the autopilot's own estimator
  std::uint64_t lost_packets = 0;
  bool knows_clock = false;
  bool is_one_way = false;  // TIMESYNC is not answered
  double round_trip_s = 0;
  double drift = 0;  // 1
  double clock_sigma_s = 0;
  int clock_jumps = 0;
  int restarts = 0;
  std::vector<std::string> events;  // events that a pilot should know
  int own_system = 0;               // system number of this program
  int autopilot_system = 0;
};

// A report of the gimbal, and the attitude of the UAV at that time.
struct GimbalObservation {
  GimbalSample sample;
  Eigen::Quaterniond world_from_body = Eigen::Quaterniond::Identity();
};

struct GimbalObservations {
  std::vector<GimbalObservation> reports;  // in order of time
  std::optional<GimbalRange> range;        // as the autopilot reports it
  // Who has primary control, by MAVLink's ids, 0: nobody; nothing: the autopilot does not say.
  struct Controller {
    int system = 0;
    int component = 0;
  };
  std::optional<Controller> controller;
};

struct ComputerObservations {
  int cores = 1;
  double load = 0;                           // processes that run or wait, mean of a minute
  std::optional<double> hottest_c;           // highest temperature of all thermal zones
  std::optional<std::uint32_t> throttled;    // Raspberry Pi's flags
  std::optional<double> free_disk_mb;        // on the disk of the recording
  double least_disk_mb = 0;                  // room that the recorder leaves free
  double frame_mb = 0;                       // size of a frame, uncompressed
  bool is_disk_read_only = false;            // the disk of the recording
  std::optional<double> disk_mb_per_s = {};  // at which it can be written
  std::optional<double> disk_wear = {};      // used share of its life, by its own account; 0 to 1
  bool has_low_voltage = false;              // the alarm of a Raspberry Pi's supply
  std::optional<bool> is_time_synchronized = {};  // the time of day, by NTP, GNSS or another source
  bool has_battery_clock = true;                  // keeps the time of day while it is off
};

// A camera and what it showed.
struct CameraSetup {
  CameraCalibration calibration;
  CameraObservations camera;
  VisionObservations vision;
};

// The set-up of the first camera, and all else.
struct DoctorObservations : CameraSetup {
  std::vector<CameraSetup> further;   // cameras
  std::vector<std::string> unopened;  // why cameras beside these could not be opened
  DoctorUse use;
  LinkObservations link;
  GimbalObservations gimbal;
  ParameterValues parameters;
  ComputerObservations computer;
};

}  // namespace kestrel
