// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/comms/mavlink/autopilot.h"
#include "kestrel/comms/mavlink/connection.h"
#include "kestrel/comms/mavlink/target_profile.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/core/camera/exposure_controller.h"
#include "kestrel/flight/onboard/exposure_drive.h"
#include "kestrel/flight/onboard/flight_program.h"
#include "kestrel/flight/onboard/flight_recorder.h"
#include "kestrel/flight/onboard/hunt_vision.h"
#include "kestrel/flight/onboard/landing_vision.h"
#include "kestrel/flight/onboard/recording_switch.h"
#include "kestrel/flight/session/live_source.h"
#include "kestrel/flight/session/observation_sinks.h"
#include "kestrel/io/recording/output_folder.h"
#include "kestrel/io/recording/truth_rows.h"
#include "kestrel/vision/objects/color_grid.h"
#include "kestrel/vision/objects/object_model.h"
#include "kestrel/vision/pipeline/hunt_pipeline.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"

namespace kestrel {

struct LiveSessionOptions {
  LandingPipelineOptions landing;
  HuntPipelineOptions hunt;
  FlightOptions flight;
  ConnectionOptions link;
  AutopilotOptions autopilot;
  FlightRecorderOptions recorder;
  // Exposure that keeps the image right; nothing: the camera does that itself.
  std::optional<ExposureOptions> exposure;
  // Height of the camera above the target or the ground, where there are no poses.
  std::optional<double> altitude_m = {};
};

// Parts of a session. The objects that pointers name must outlive it.
struct LiveSessionParts {
  LiveSource* source = nullptr;
  CameraCalibration calibration;
  double rate_hz = 0;                  // of the images, nominal
  bool has_poses = false;              // the source has some: those of the autopilot are not used
  ExposureActuator* camera = nullptr;  // sets the exposure; null: it cannot be set

  // Processes images that equal the one before. False: a camera that repeats its image is frozen.
  bool sees_repeated = false;

  std::optional<ObjectModel> objects;  // hunts for these; nothing: looks for the landing pattern
  std::optional<ColorGrid> grid;       // of the objects' colours; nothing: the model's own
  ObservationSink* sink = nullptr;     // takes all results and events; null: nobody

  std::string autopilot;               // URL as of Connection; empty: none
  std::optional<LinkProfile> profile;  // nothing: by the autopilot's heartbeat
  bool guides = false;                 // flies by set-points when the pilot gives the mode

  std::string output;  // folder of the tables; empty: none
  std::string record;  // folder of a recording that begins at once; empty: none
  bool replace = false;

  // Set by a simulation: receive the autopilot's estimated and true poses; the true pattern of a
  // frame.
  std::function<void(const PoseSample&)> pose;
  std::function<void(const PoseSample&)> true_pose;
  std::function<std::optional<TruePattern>(const Frame&)> truth;
};

// A flight as a library: a live source, the pipeline, the autopilot, guidance, a recorder and
// sinks, put together. `kestrel fly` is this with a command line.
//
//   ObservationSinks sinks;
//   sinks.Add(std::make_unique<MySink>());
//   LiveSession session({.source = &camera, .calibration = ReadCalibration("camera.yaml"),
//                        .sink = &sinks, .autopilot = "serial:///dev/ttyAMA0:921600"}, {});
//   session.Run([] { return false; });
//   sinks.Finish();
class LiveSession {
 public:
  // Opens the files and the connection. Throws InputError when parts or options are not valid, or
  // something cannot be opened.
  LiveSession(LiveSessionParts parts, LiveSessionOptions options);
  // Ends a recording that is on.
  ~LiveSession();
  LiveSession(const LiveSession&) = delete;
  LiveSession& operator=(const LiveSession&) = delete;

  // Flies until it has landed, the source ends or 'is_stopped', which is asked ten times a second
  // by this thread, says so. Then all tables and the recording are written. Once only.
  FlightEnd Run(const std::function<bool()>& is_stopped);

  // Continues with the options of the pipeline and the altitude in 'options', see ChangeOptions of
  // the pipelines. Track, map and all other options stay. By any thread.
  void Change(const LiveSessionOptions& options);
  // Calls 'action' between two frames: the vision waits for it. By any thread.
  void BetweenFrames(const std::function<void()>& action) { program_->BetweenFrames(action); }

  // Starts and stops recordings. By any thread.
  RecordingSwitch& recording() { return recording_; }
  // The hunt; null: it looks for the landing pattern.
  HuntVision* hunt() { return hunt_; }
  // The folder of the tables; null: none.
  const OutputFolder* output() const { return output_ ? &*output_ : nullptr; }

  // The state as the sinks get it. By any thread.
  FlightReport Report() const { return program_->Report(); }
  // One line of how things are now. By any thread.
  std::string State() const { return program_->State(); }
  // Latency of each step, what was dropped and what was sent; a few lines. After Run.
  std::string Summary() const;

 private:
  void OpenVision();
  void OpenAutopilot();
  std::optional<ExposureDrive> Exposure();
  std::unique_ptr<FlightRecorder> OpenRecorder(const std::filesystem::path& folder, bool replace);
  FlightParts ProgramParts();
  void Say(const std::string& text, EventLevel level = EventLevel::kInfo);
  void TakePose(const PoseSample& pose);
  void TakeTruePose(const PoseSample& pose);

  LiveSessionParts parts_;
  LiveSessionOptions options_;
  std::optional<GuardedSink> sink_;
  std::string sink_error_;  // what the sink has thrown; read after Run only
  RecordingSwitch recording_;
  std::optional<OutputFolder> output_;
  std::unique_ptr<ExposureActuator> actuator_;
  std::unique_ptr<FlightVision> vision_;
  LandingVision* landing_ = nullptr;  // one of these is the vision
  HuntVision* hunt_ = nullptr;
  std::optional<Connection> connection_;
  std::optional<Autopilot> autopilot_;
  std::optional<FlightProgram> program_;
};

}  // namespace kestrel
