// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/core/camera/calibration.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/flight/onboard/exposure_actuator.h"
#include "kestrel/flight/onboard/gstreamer_camera.h"
#include "kestrel/flight/onboard/late_video.h"
#include "kestrel/flight/session/live_source.h"
#include "kestrel/io/bags/open_recording.h"
#include "kestrel/io/recording/euroc/truth_rows.h"
#include "kestrel/io/recording/frame.h"

namespace kestrel {

// A camera whose images come late.
struct LateCamera {
  std::size_t camera = 0;      // its index
  std::string name = {};       // for messages; empty: it is the only camera
  LateVideo* video = nullptr;  // view of the source, or of a part of it
};

// A live source, its calibration, and what a session wants to know about it.
struct OpenedLiveSource {
  std::unique_ptr<LiveSource> source = {};
  CameraCalibration calibration = {};
  // Those of the further cameras: of frames with the indices 1, 2, ... All have their names then.
  std::vector<CameraCalibration> further = {};
  double rate_hz = kNominalRateHz;       // nominal
  bool has_poses = false;                // the source has poses of its own
  ExposureActuator* actuator = nullptr;  // view of 'source'; null: its exposure cannot be set

  std::vector<LateCamera> late = {};

  // Images that equal the one before are processed. False: a camera that repeats its image is
  // frozen.
  bool sees_repeated = false;

  // Set by a simulation: receive the autopilot's estimated and true poses; the true pattern of a
  // frame.
  std::function<void(const PoseSample&)> pose = {};
  std::function<void(const PoseSample&)> true_pose = {};
  std::function<std::optional<TruePattern>(const Frame&)> truth = {};
  // Set by a simulation: the true offset of the touch-down, see FlightEnd; nothing before it.
  // Called by the link's thread.
  std::function<std::optional<double>()> true_offset_m = {};
};

// A live source to be opened: a camera, a recording that is played in real time, or the URI of a
// scheme.
struct LiveSourceChoice {
  RecordingChoice recording;  // its 'sources' has one element, the URI
  bool is_looped = false;     // a recording begins again after its end
  std::string camera = {};    // its entry in a calibration file of several; empty: the only one

  const std::string& uri() const { return recording.sources.front(); }
};

// A kind of source that is known by the beginning of its URI.
struct SourceScheme {
  std::string prefix;  // "dds:"
  std::function<OpenedLiveSource(const LiveSourceChoice&)> open;
};

// Opens what the URI names: a source of a scheme ("dds:/camera/image_raw", "sim:straight"), a
// camera
// (/dev/video0, rtsp://..., a GStreamer pipeline), or a recording, which is played in real time.
// A camera without a calibration file is opened where the recording's choice says
// 'may_assume_lens': its calibration then has width 0. Throws InputError that says what is wrong
// with the source.
OpenedLiveSource OpenLiveSource(const LiveSourceChoice& choice,
                                const GstreamerCameraOptions& camera,
                                const std::vector<SourceScheme>& schemes = {});

// Opens several cameras, or several sources of one scheme, as one source: cam0, cam1 and so on.
// Their calibrations are files of one camera each, or one file with an entry for each. One that
// cannot be opened is left out, with a line to 'notify', as long as another one can. Throws
// InputError when none can be opened, when one is of another kind, or is given twice.
OpenedLiveSource OpenLiveCameras(const std::vector<RecordingChoice>& cameras,
                                 const GstreamerCameraOptions& options,
                                 const std::function<void(const std::string&)>& notify,
                                 const std::vector<SourceScheme>& schemes = {});

// Returns the calibration of the choice's file, with its clock offset, for sources that have none
// of their own. 'name': of the camera, in a file with several. Throws InputError when the file is
// not valid.
CameraCalibration ChosenCalibration(const RecordingChoice& choice, const std::string& name = "");

}  // namespace kestrel
