// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/flight/session/flight_report.h"
#include "kestrel/flight/session/live_source.h"
#include "kestrel/flight/session/observation_sink.h"
#include "kestrel/flight/session/task.h"
#include "kestrel/io/recording/frame.h"

namespace kestrel {

class ExposureActuator;
class RecordingSwitch;
enum class LinkProfile;
struct LiveSessionOptions;
struct TaskOptions;
struct TruePattern;

// Parts of a session. The objects that pointers name must outlive it.
struct LiveSessionParts {
  LiveSource* source = nullptr;
  CameraCalibration calibration;
  double rate_hz = 0;                  // of the images, nominal
  bool has_poses = false;              // the source has some: those of the autopilot are not used
  ExposureActuator* camera = nullptr;  // sets the exposure; null: it cannot be set

  // Processes images that equal the one before. False: a camera that repeats its image is frozen.
  bool sees_repeated = false;

  std::shared_ptr<const Task> task;  // null: looks for the pad, with the default options
  ObservationSink* sink = nullptr;   // takes all results and events; null: nobody

  std::string autopilot;               // URL as of Connection; empty: none
  std::optional<LinkProfile> profile;  // nothing: by the autopilot's heartbeat
  // Flies by set-points when the pilot gives the mode. A guard, a process of its own, then has the
  // line (docs/guard.md), unless the setting fly.guard.enabled says otherwise.
  bool guides = false;

  // Points the camera's gimbal at the pad in flight; always where 'guides' is set and there is one.
  bool points = false;

  std::string output;  // folder of the tables; empty: none
  std::string record;  // folder of a recording that begins at once; empty: none
  bool replace = false;

  // Set by a simulation: receive the autopilot's estimated and true poses; the true pattern of a
  // frame.
  std::function<void(const PoseSample&)> pose;
  std::function<void(const PoseSample&)> true_pose;
  std::function<std::optional<TruePattern>(const Frame&)> truth;
  // Set by a simulation: the true offset of the touch-down, see FlightEnd; nothing before it.
  // Called by the link's thread.
  std::function<std::optional<double>()> true_offset_m;
};

// A flight as a library: a live source, the pipeline, the autopilot, guidance, a recorder and
// sinks, put together. `kestrel fly` is this with a command line.
class LiveSession {
 public:
  // Opens the files and the connection. 'settings' change the defaults of the options that `kestrel
  // config` prints as fly and, where the parts have no task, as landing:
  // "landing.detector.pattern.outer_diameter_m=0.6", "fly.rate_hz=20". Throws InputError when parts
  // or settings are not valid, or something cannot be opened.
  explicit LiveSession(LiveSessionParts parts, const std::vector<std::string>& settings = {});
  LiveSession(LiveSessionParts parts, LiveSessionOptions options);
  // Ends a recording that is on.
  ~LiveSession();
  LiveSession(const LiveSession&) = delete;
  LiveSession& operator=(const LiveSession&) = delete;

  // Flies until it has landed, the source ends or 'is_stopped', which is asked ten times a second
  // by this thread, says so. Then all tables and the recording are written. Once only.
  FlightEnd Run(const std::function<bool()>& is_stopped);

  // Continues with these options of the task, and the altitude, see Vision::Change. By any thread.
  void Change(const TaskOptions& options, std::optional<double> altitude_m = std::nullopt);
  // Calls 'action' between two frames: the vision waits for it. By any thread.
  void BetweenFrames(const std::function<void()>& action);

  // Starts and stops recordings. By any thread.
  RecordingSwitch& recording();
  // The vision, for what changes between two frames only.
  const Vision& vision() const;

  // The state as the sinks get it. By any thread.
  FlightReport Report() const;
  // One line of how things are now. By any thread.
  std::string State() const;
  // Latency of each step, what was dropped and what was sent; a few lines. After Run.
  std::string Summary() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace kestrel
