// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/app/console/messages/calibration_state.h"
#include "kestrel/app/console/messages/client_message.h"
#include "kestrel/app/console/messages/color_state.h"
#include "kestrel/app/console/messages/export_request.h"
#include "kestrel/app/console/messages/lens_state.h"
#include "kestrel/app/console/messages/settings_state.h"
#include "kestrel/app/console/messages/study_state.h"
#include "kestrel/app/views/view_data.h"
#include "kestrel/core/base/bounded_queue.h"
#include "kestrel/core/base/latest_value.h"
#include "kestrel/core/base/time.h"
#include "kestrel/flight/session/session_event.h"

namespace kestrel {

// A frame and what was found in it.
struct ConsoleFrame {
  std::uint64_t sequence = 0;  // from 1, set by the feed; 0: no frame yet
  Time captured;
  cv::Mat image;  // 8-bit gray or BGR; nobody changes it any more
  std::vector<OverlayShape> shapes;
};

// Ages of what the sources of a flight gave last; nothing where a source has given nothing yet.
// Sources that the flight does not have are left out.
struct ConsoleSources {
  struct Age {
    ValueSource source = ValueSource::kFrames;
    std::optional<Duration> age;
  };
  Time time;  // time at which the ages were measured
  std::vector<Age> ages;
};

// All samples of a recording: its plots at once.
struct ConsoleSeries {
  std::vector<Duration> times;              // frame times since the first frame
  std::vector<std::vector<double>> values;  // for each series its values; NaN where unknown
};

// One check of the program's health, like those of the doctor.
struct ConsoleCheck {
  std::string name;
  std::string verdict;      // "good", "doubtful", "wrong", "not checked"
  std::string measured;     // in words
  std::string advice = {};  // what to do; empty when all is well

  bool operator==(const ConsoleCheck&) const = default;
};
struct ConsoleHealth {
  std::vector<ConsoleCheck> checks;
};
// The vehicle, for the head of the page: mode, battery and so on, and the used parts of the limits.
struct ConsoleVehicle {
  struct Use {
    std::string limit;  // as "lean"
    double share = 0;   // 0 to 1

    bool operator==(const Use&) const = default;
  };
  std::vector<ConsoleCheck> facts;
  std::vector<Use> limits;    // empty while guidance does not fly
  std::string cannot_follow;  // why the target cannot be followed; empty: it can

  bool operator==(const ConsoleVehicle&) const = default;
};
// The checks of `kestrel doctor` that are possible in flight.
struct ConsoleDoctor {
  std::vector<ConsoleCheck> checks;
};

// The frames of a recording for the timeline.
enum class FrameMark { kNothing, kFound, kLost, kFalse };
struct ConsoleTimeline {
  Time begin;
  std::vector<Duration> times;   // time of each frame since begin, in order
  std::vector<FrameMark> marks;  // one for each frame
};

// The frame of a recording that is shown, and the speed of play; 0: held.
struct ConsolePlayback {
  std::uint64_t frame = 0;
  double speed = 0;
};

// Messages of the autopilot of a recorded flight; the page shows those up to its frame.
struct ConsoleLog {
  std::vector<SessionEvent> events;  // in order of time
};

// Facts about the frame that is shown: those of the first run and, once it is done, of the second.
// Both have the same names in the same order.
struct ConsoleFindings {
  std::uint64_t frame = 0;
  std::vector<std::vector<ViewFact>> runs;
};

// An option that the page can change for a second run, with its name in `kestrel config`.
struct ConsoleOption {
  std::string name;
  std::string value;  // its present value
  std::string unit;
  std::string meaning;
};
struct ConsoleOptionList {
  std::vector<ConsoleOption> options;
};

// A second run over the recording with other options, to be compared with the first.
enum class SecondRunState { kNone, kRunning, kDone, kCancelled, kFailed };
struct ConsoleSecondRun {
  SecondRunState state = SecondRunState::kNone;
  std::vector<std::string> settings;  // the options that differ, as "landing.still=true"
  std::size_t done = 0;               // number of frames done
  std::string error;                  // why it failed
  std::vector<FrameMark> marks;       // one for each frame, once the run is done
};

// Progress of a clip in frames. 'frames' is 0 when no clip is being made.
struct ConsoleClip {
  std::size_t done = 0;
  std::size_t frames = 0;
};

using ConsoleUpdate =
    std::variant<ViewSample, ViewStatus, ViewMap, ConsoleHealth, SessionEvent, ConsoleTimeline,
                 ConsolePlayback, ConsoleDoctor, ConsoleOptionList, ConsoleSecondRun,
                 ConsoleFindings, ConsoleClip, ConsoleColors, ConsoleColorScores,
                 ConsoleCalibration, ViewedTeam, ConsoleVehicle, ConsoleStudy, ConsoleStudyReplay,
                 ConsoleSources, ConsoleSeries, ConsoleLens, ConsoleLog, ConsoleSettings>;

// A task of the page of colours.
using ColorJob = std::variant<ColorRequest, PendingExport>;

// The hand-over between a program that flies, or plays a recording, and the console's thread. No
// function on the program's side ever waits for the console: the newest frame replaces the one
// before, and when the queue of updates is full the oldest is dropped.
class ConsoleFeed {
 public:
  struct Description {
    std::string title;                       // title of the page
    bool is_live = true;                     // times are those of Now()
    std::vector<SeriesDescription> series;   // the values of a ViewSample
    std::vector<OverlayLayer> layers;        // layers that the shapes can have
    std::vector<ImageView> views;            // views beside the camera's image
    std::vector<ConsoleCommandKind> offers;  // commands that the program executes
    bool has_exports = false;                // the program answers TakeExport
    bool has_colors = false;                 // the program executes TakeColorJob
  };

  explicit ConsoleFeed(Description description);

  // The program's side.

  // True when a browser looks at the page. Otherwise frames and samples need not be made. Any
  // thread.
  bool IsWatched() const { return watchers_.load(std::memory_order_relaxed) > 0; }
  // Called by one thread; the feed sets the sequence number. Does not lock. It allocates only until
  // it has seen the greatest number of shapes.
  void SetFrame(ConsoleFrame* frame);
  // Any thread.
  void Add(ConsoleUpdate update) { updates_.Push(std::move(update)); }
  // Returns the next command of a user, or nothing when there is none. Any thread.
  std::optional<ConsoleCommand> TakeCommand() { return commands_.TryPop(); }

  // Returns the next request to be answered, or nothing when there is none. Any thread.
  std::optional<PendingExport> TakeExport() { return exports_.TryPop(); }

  // Returns the next task of the page of colours, or nothing when none comes within 'timeout'. Any
  // thread.
  std::optional<ColorJob> TakeColorJob(Duration timeout) { return color_jobs_.Pop(timeout); }

  // The console's side. Called by its thread only.

  const Description& description() const { return description_; }
  void SetWatchers(int count) { watchers_.store(count, std::memory_order_relaxed); }
  // Returns the newest frame, valid until the next call; its sequence is 0 before the first frame.
  const ConsoleFrame& NewestFrame() { return frame_.Get(); }
  std::optional<ConsoleUpdate> TakeUpdate() { return updates_.TryPop(); }
  void Command(const ConsoleCommand& command) { commands_.Push(command); }
  // When the queue is full the oldest request is dropped and never answered.
  void Export(PendingExport pending);
  void Request(const ColorRequest& request);

 private:
  Description description_;
  std::atomic<int> watchers_{0};
  std::uint64_t sequence_ = 0;  // used by the thread of SetFrame only
  LatestValue<ConsoleFrame> frame_;
  BoundedQueue<ConsoleUpdate> updates_;
  BoundedQueue<ConsoleCommand> commands_;
  BoundedQueue<PendingExport> exports_;
  BoundedQueue<ColorJob> color_jobs_;
};

}  // namespace kestrel
