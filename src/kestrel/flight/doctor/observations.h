// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/comms/mavlink/autopilot.h"
#include "kestrel/comms/mavlink/connection.h"
#include "kestrel/comms/mavlink/link_url.h"
#include "kestrel/comms/mavlink/target_profile.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/flight/doctor/image_quality.h"
#include "kestrel/flight/doctor/parameter_values.h"
#include "kestrel/flight/session/live_source.h"
#include "kestrel/vision/pipeline/calibration_monitor.h"

// What the checks look at: all that camera, autopilot and computer showed in some seconds. The
// checks are functions of these alone, whoever filled them in.
namespace kestrel {

// What the set-up is to be used for, on which the checks depend.
struct DoctorUse {
  std::optional<LinkProfile> profile;  // nothing: by the heartbeat
  bool guides = false;                 // Kestrel flies the UAV by set-points
  std::optional<double> target_mps;    // speed of a target that moves; nothing: it stands
  bool sends_distance = false;         // DISTANCE_SENSOR too
  double attitude_rate_hz = 100;       // asked of the autopilot
  double position_rate_hz = 50;        //
  std::optional<double> link_delay_s;  // as configured; nothing: by the round trip
  std::string record;                  // folder of the recording; empty: none
};

// A frame as it came.
struct FrameSample {
  Time stamp;    // when its light was collected, by the source
  Time arrival;  // both on the clock of Now()
};

struct CameraObservations {
  std::string open_error;       // why it could not be opened; empty: it was
  bool has_other_size = false;  // the reason was the size of its images
  std::string error;            // what it said last
  double duration_s = 0;        // for which it was listened to
  int width_px = 0;             // of its images; 0: there were none
  int height_px = 0;
  std::vector<FrameSample> frames;      // in the order in which they came
  std::vector<ImageQuality> qualities;  // of those that were looked at
  CaptureCounters counters;
};

// The pattern in one frame, found without any knowledge of mount and attitude.
struct PatternSample {
  Time time;  // of the frame, on the navigation's clock
  RigidTransform camera_from_pattern;
  std::optional<RigidTransform> mirror_camera_from_pattern;
  double ring_px = 0;        // its smaller diameter
  double misfit_px = 0;      // how far the edges are from where pose and lens have them
  bool contradicts = false;  // the calibration cannot explain it
  std::optional<RigidTransform> world_from_body;  // by the autopilot
};

struct VisionObservations {
  int frames = 0;          // processed
  int dropped_frames = 0;  // because the frame before was still processed
  std::vector<PatternSample> patterns;
  std::optional<FocalFactor> focal;                // what they say of the focal length
  std::optional<FocalFactor> focal_contradiction;  // the same, where it contradicts
  double detect_s = 0;                             // median and
  double detect_p90_s = 0;
  double latency_s = 0;  // median, from the frame's light to the detection
};

struct LinkObservations {
  bool is_asked = false;   // an autopilot was given at all
  std::string open_error;  // why the line could not be opened; empty: it was
  LinkScheme scheme = LinkScheme::kUdpIn;
  int baud = 0;               // of a serial line
  bool is_signed = false;     // this side signs
  bool hears_signed = false;  // the other side does
  ConnectionCounters counters;
  bool is_heard = false;  // a heartbeat, in the end
  AutopilotKind kind = AutopilotKind::kUnknown;
  std::optional<AutopilotVersion> version;
  std::optional<std::uint8_t> vehicle_type;  // MAV_TYPE
  std::string mode;
  bool is_armed = false;
  int heartbeats = 0;
  double listened_s = 0;  // to the streams
  int attitudes = 0;      // messages in that time
  int positions = 0;
  double attitude_age_s = 0;  // of the newest one, at the end
  double position_age_s = 0;
  std::optional<bool> has_good_position;  // by the autopilot's own estimator
  std::uint64_t lost_packets = 0;
  bool knows_clock = false;
  bool is_one_way = false;  // TIMESYNC is not answered
  double round_trip_s = 0;
  double drift = 0;  // 1
  double clock_sigma_s = 0;
  int clock_jumps = 0;
  int restarts = 0;
  std::vector<std::string> events;  // what a pilot should know
  int own_system = 0;               // this program's
};

struct ComputerObservations {
  int cores = 1;
  double load = 0;                         // processes that run or wait, mean of a minute
  std::optional<double> hottest_c;         // of the thermal zones
  std::optional<std::uint32_t> throttled;  // Raspberry Pi's flags
  std::optional<double> free_disk_mb;      // where the recording goes
  double least_disk_mb = 0;                // that the recorder leaves
  double frame_mb = 0;                     // of a frame, uncompressed
};

struct DoctorObservations {
  DoctorUse use;
  CameraCalibration calibration;
  CameraObservations camera;
  VisionObservations vision;
  LinkObservations link;
  ParameterValues parameters;
  ComputerObservations computer;
};

}  // namespace kestrel
