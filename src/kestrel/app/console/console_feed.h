// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/app/console/calibration_report.h"
#include "kestrel/app/console/client_message.h"
#include "kestrel/app/console/color_state.h"
#include "kestrel/app/console/export_request.h"
#include "kestrel/core/base/bounded_queue.h"
#include "kestrel/core/base/latest_value.h"
#include "kestrel/core/base/time.h"
#include "kestrel/flight/session/session_event.h"

namespace kestrel {

// What the page can show over the image, each kind switched by itself; kTruth: what there is to be
// found, where that is known, kSecond: all that a second run found.
enum class OverlayLayer { kDetection, kPrediction, kRejected, kTruth, kSecond };
// "detection", "prediction", "rejected", "truth", "second"
const char* ToString(OverlayLayer layer);

// A closed line over the image with a word about it: what was found and how, or why it was not.
struct OverlayShape {
  OverlayLayer layer = OverlayLayer::kDetection;
  std::vector<cv::Point2f> outline;  // pixels; one point is a mark
  std::string label;
  int run = 1;  // of the detector over a recording: the first or the second
};

// A frame and what was found in it.
struct ConsoleFrame {
  std::uint64_t sequence = 0;  // from 1, given by the feed; 0: none yet
  Time captured;
  cv::Mat image;  // 8-bit gray or BGR, which nobody changes any more
  std::vector<OverlayShape> shapes;
};

// What a browser can look at in the place of the camera's image, under the same shapes.
struct ImageView {
  std::string name;  // for people, as "threshold 1/8"
  // Of an image of a ConsoleFrame one of the same size, 8-bit gray or BGR; empty: there is none. By
  // the console's thread, and only while a browser wants it.
  std::function<cv::Mat(const cv::Mat& image)> draw;
};

// A quantity that the page draws over time.
struct SeriesDescription {
  std::string name;   // as "height"
  std::string unit;   // as "m"; empty for a pure number
  std::string label;  // for people
};

// One value for each series; NaN where it is not known.
struct ConsoleSample {
  Time time;
  std::vector<double> values;
};

// How things are, in words for a pilot at a glance.
struct ConsoleStatus {
  std::string state;   // as "searching", "tracking", "landing"
  std::string reason;  // why not more than that; empty where there is nothing to say
  bool is_recording = false;

  bool operator==(const ConsoleStatus&) const = default;
};

// A point on the map with what is known of it; world frame, m and rad.
struct ConsoleMapObject {
  std::string label;
  std::string color;  // its class, as "red"; empty: none
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
};
struct ConsoleMap {
  std::optional<Eigen::Vector2d> uav;
  double uav_heading = 0;  // from x (east) to y
  std::optional<ConsoleMapObject> target;
  Eigen::Vector2d target_velocity = Eigen::Vector2d::Zero();  // m/s
  std::vector<ConsoleMapObject> prediction;                   // where the target will be, in order
  std::vector<ConsoleMapObject> objects;                      // in view
  std::vector<ConsoleMapObject> mapped;                       // what a hunt's map has by now
};

// What the UAV's team knows of, in this UAV's world.
struct ConsoleTeamObject {
  ConsoleMapObject object;
  std::vector<std::string> uavs;  // that have it in their maps, by name
  std::string holder;             // the one that goes for it; empty: none
};
struct ConsoleTeam {
  std::vector<ConsoleTeamObject> objects;
};

// One check of the program's health, as the doctor's.
struct ConsoleCheck {
  std::string name;
  std::string verdict;      // "good", "doubtful", "wrong", "not checked"
  std::string measured;     // in words
  std::string advice = {};  // what to do; empty where all is well
};
struct ConsoleHealth {
  std::vector<ConsoleCheck> checks;
};
// The checks of `kestrel doctor` that can be made in flight.
struct ConsoleDoctor {
  std::vector<ConsoleCheck> checks;
};

// The frames of a recording, for the timeline.
enum class FrameMark { kNothing, kFound, kLost, kFalse };
struct ConsoleTimeline {
  Time begin;
  std::vector<Duration> times;   // of each frame, since begin, in order
  std::vector<FrameMark> marks;  // as many
};

// Where a recording is: the frame that is shown, and how fast it plays, 0: held.
struct ConsolePlayback {
  std::uint64_t frame = 0;
  double speed = 0;
};

// Something about a frame in words, as "method": "quadrants".
struct ConsoleFact {
  std::string name;
  std::string value;
};
// What the first run found in the frame that is shown and, once it is done, the second; the same
// names in the same order.
struct ConsoleFindings {
  std::uint64_t frame = 0;
  std::vector<std::vector<ConsoleFact>> runs;
};

// An option that the page can change for a second run, by its name in `kestrel config`.
struct ConsoleOption {
  std::string name;
  std::string value;  // that it has
  std::string unit;
  std::string meaning;
};
struct ConsoleOptionList {
  std::vector<ConsoleOption> options;
};

// The recording once more, with other options, to be compared with the first run.
enum class SecondRunState { kNone, kRunning, kDone, kCancelled, kFailed };
struct ConsoleSecondRun {
  SecondRunState state = SecondRunState::kNone;
  std::vector<std::string> settings;  // what is other, as "landing.still=true"
  std::size_t done = 0;               // frames
  std::string error;                  // why it failed
  std::vector<FrameMark> marks;       // of each frame, once it is done
};

// A clip that is made: how many of its frames are. None are when no clip is.
struct ConsoleClip {
  std::size_t done = 0;
  std::size_t frames = 0;
};

using ConsoleUpdate =
    std::variant<ConsoleSample, ConsoleStatus, ConsoleMap, ConsoleHealth, SessionEvent,
                 ConsoleTimeline, ConsolePlayback, ConsoleDoctor, ConsoleOptionList,
                 ConsoleSecondRun, ConsoleFindings, ConsoleClip, ConsoleColors, ConsoleColorScores,
                 ConsoleCalibration, ConsoleTeam>;

// What is to be done by the page of colours.
using ColorJob = std::variant<ColorRequest, PendingExport>;

// The hand-over between a program that flies, or plays a recording, and the console's thread. No
// function of the program's side ever waits for the console: the newest frame replaces the one
// before, and of too many updates the oldest is lost.
class ConsoleFeed {
 public:
  struct Description {
    std::string title;                       // of what is shown
    bool is_live = true;                     // times are those of Now()
    std::vector<SeriesDescription> series;   // what a ConsoleSample holds
    std::vector<OverlayLayer> layers;        // of the shapes that there can be
    std::vector<ImageView> views;            // beside the camera's image
    std::vector<ConsoleCommandKind> offers;  // the commands that the program obeys
    bool has_exports = false;                // the program answers TakeExport
    bool has_colors = false;                 // the program does what TakeColorJob gives
  };

  explicit ConsoleFeed(Description description);

  // The program's side.

  // Whether anybody looks: else frames and samples need not be made. By any thread.
  bool IsWatched() const { return watchers_.load(std::memory_order_relaxed) > 0; }
  // By one thread: the feed gives the sequence number. Does not lock; it allocates only until it
  // has seen as many shapes as there are.
  void SetFrame(ConsoleFrame* frame);
  // By any thread.
  void Add(ConsoleUpdate update) { updates_.Push(std::move(update)); }
  // What the user has asked for since; nothing when there is nothing. By any thread.
  std::optional<ConsoleCommand> TakeCommand() { return commands_.TryPop(); }

  // What is to be answered next; nothing when there is nothing. By any thread.
  std::optional<PendingExport> TakeExport() { return exports_.TryPop(); }

  // What the page of colours is to do next; nothing when there is nothing within 'timeout'. By any
  // thread.
  std::optional<ColorJob> TakeColorJob(Duration timeout) { return color_jobs_.Pop(timeout); }

  // The console's side, by its thread.

  const Description& description() const { return description_; }
  void SetWatchers(int count) { watchers_.store(count, std::memory_order_relaxed); }
  // The newest frame, valid until the next call; its sequence is 0 before the first.
  const ConsoleFrame& NewestFrame() { return frame_.Get(); }
  std::optional<ConsoleUpdate> TakeUpdate() { return updates_.TryPop(); }
  std::size_t dropped_updates() const { return updates_.dropped(); }
  void Command(const ConsoleCommand& command) { commands_.Push(command); }
  // Of too many the oldest is never answered.
  void Export(PendingExport pending);
  void Ask(const ColorRequest& request);

 private:
  Description description_;
  std::atomic<int> watchers_{0};
  std::uint64_t sequence_ = 0;  // of the thread of SetFrame
  LatestValue<ConsoleFrame> frame_;
  BoundedQueue<ConsoleUpdate> updates_;
  BoundedQueue<ConsoleCommand> commands_;
  BoundedQueue<PendingExport> exports_;
  BoundedQueue<ColorJob> color_jobs_;
};

}  // namespace kestrel
