// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <utility>

#include <opencv2/core.hpp>

#include "kestrel/comms/mavlink/target_profile.h"
#include "kestrel/comms/team/team_goal.h"
#include "kestrel/flight/guidance/go_job.h"
#include "kestrel/flight/guidance/relative_guidance.h"
#include "kestrel/flight/onboard/camera_stream.h"
#include "kestrel/flight/onboard/flight_options.h"
#include "kestrel/flight/onboard/open_live_source.h"
#include "kestrel/flight/session/flight_end.h"
#include "kestrel/flight/session/flight_report.h"
#include "kestrel/flight/session/follow_task.h"  // IWYU pragma: export
#include "kestrel/flight/session/hunt_task.h"    // IWYU pragma: export
#include "kestrel/flight/session/land_task.h"    // IWYU pragma: export
#include "kestrel/flight/session/observation_sinks.h"
#include "kestrel/flight/session/task.h"
#include "kestrel/io/bags/open_recording.h"

namespace kestrel {

class RecordingSwitch;

// Options of a session, beside those of its task.
struct SessionOptions {
  // Height of the camera above what is looked for, where there are no poses.
  std::optional<double> altitude_m = {};
  std::string output = {};  // folder of the tables; empty: none
  bool replace = false;     // files that are there, in 'output' and 'record'

  // Options of a session over a recording.
  std::string annotate = {};  // frames with the results, in 'output': "video", "images" or empty
  std::ostream* table = nullptr;  // receives the table where there is no 'output'; null: nobody

  // Options of a flight.
  FlightOptions flight = {};
  std::string autopilot = {};               // URL as of Connection; empty: none
  std::optional<LinkProfile> profile = {};  // nothing: by the autopilot's heartbeat
  // Flies by set-points when the pilot gives the mode. A guard, a process of its own, then has the
  // line (docs/guard.md), unless flight.guard.enabled is false.
  bool guides = false;
  // The job at the object of the task, where the UAV flies to one, at what is marked or at a place;
  // needs 'guides'.
  GoJob job = {};
  std::optional<GlobalPosition> place = {};  // for a job at a place
  std::optional<GlobalPosition> box = {};    // where a job that delivers takes the objects
  // Points the camera's gimbal at the target; 'guides' does so, too. Needs a calibration with a
  // gimbal.
  bool points = false;
  std::string record = {};  // folder of a recording that begins at once; empty: none
  // Sends the UAV's place over the pad to the autopilot as its position: it needs no other. The pad
  // stands. Needs a task with a pad, and an autopilot.
  bool sends_pad_position = false;
  // Flies over the pad, and onto it, without any position of the autopilot, or once that is lost;
  // needs 'guides' and a task with a pad.
  std::optional<RelativeJob> without_position = {};
  // The video in which ground stations mark what is followed; nothing: that of the source.
  std::optional<CameraStream> stream = {};
};

// A source, the vision of a task, and sinks, put together: what `kestrel land`, `hunt`, `follow`
// and, live, `fly` run.
class Session {
 public:
  virtual ~Session() = default;
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  // The vision; in flight, for what changes between two frames only.
  const Vision& vision() const { return *vision_; }
  // Receivers of all results and events, for Add before Run. A sink that throws ends a session over
  // a recording; a flight goes on without it.
  ObservationSinks& sinks() { return sinks_; }
  const ObservationSinks& sinks() const { return sinks_; }

  // Runs until the source ends, the UAV has landed or 'is_stopped' returns true, which this thread
  // calls before each frame of a recording, and ten times a second in flight. Then writes the
  // tables and finishes the sinks. Throws InputError when a recording, its vision or one of its
  // sinks does (the sinks are then not finished), and what 'is_stopped' throws. Once only.
  virtual FlightEnd Run(const std::function<bool()>& is_stopped) = 0;
  FlightEnd Run() {
    return Run([] { return false; });
  }

  // Returns some lines: the number of frames, what was found, and how long it took. After Run.
  virtual std::string Summary() const = 0;

 protected:
  Session(std::unique_ptr<Vision> vision, SinkErrors errors)
      : vision_(std::move(vision)), sinks_(errors) {}

  Vision& mutable_vision() { return *vision_; }

 private:
  std::unique_ptr<Vision> vision_;
  ObservationSinks sinks_;
};

// A session with a live source, in real time: a flight, with autopilot, guidance and recorder. By
// any thread:
class LiveSession : public Session {
 public:
  // Continues with these options of the task, and the altitude, see Vision::Change.
  virtual void Change(const TaskOptions& options, std::optional<double> altitude_m) = 0;
  // As Vision::Mark: a person's mark on a picture may be two seconds late.
  virtual void Mark(Time frame, const cv::Rect2d& box_px) = 0;
  // Points the gimbal again that was left to somebody else. Throws InputError where none is
  // pointed.
  virtual void ResumePointing() = 0;
  // A person's confirmation that the UAV is to fly to what is marked now, and the order to stop.
  // Throws InputError when guidance does not fly, or nothing is marked.
  virtual void Confirm() = 0;
  virtual void StopFollowing() = 0;
  // Takes what the team wants of this UAV, and returns what it does, where it flies to objects.
  virtual void Take(const TeamGoal& goal) = 0;
  virtual FlightToObjects ToObjects() const = 0;
  // Calls 'action' between two frames: the vision waits for it.
  virtual void BetweenFrames(const std::function<void()>& action) = 0;
  // Starts and stops recordings.
  virtual RecordingSwitch& recording() = 0;
  // The state as the sinks get it, and in one line.
  virtual FlightReport Report() const = 0;
  virtual std::string State() const = 0;

 protected:
  using Session::Session;
};

// Returns a session over a recording, which outlives it: passes all poses and frames in order of
// time to the vision, by the caller's thread, as fast as they go. Throws InputError when
// calibration or options are not valid; Run does when the tables cannot be written.
std::unique_ptr<Session> MakeSession(const OpenedSource& recording, const Task& task,
                                     const SessionOptions& options = {});
// The same with a vision of one's own.
std::unique_ptr<Session> MakeSession(const OpenedSource& recording, std::unique_ptr<Vision> vision,
                                     const SessionOptions& options = {});
// Returns a session with a live source, which outlives it. Opens the files and the connection.
// Throws InputError when source or options are not valid, or something cannot be opened.
std::unique_ptr<LiveSession> MakeSession(const OpenedLiveSource& source, const Task& task,
                                         const SessionOptions& options = {});

}  // namespace kestrel
