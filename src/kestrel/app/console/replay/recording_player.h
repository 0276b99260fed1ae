// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/app/console/messages/console_feed.h"
#include "kestrel/app/console/replay/clip_maker.h"
#include "kestrel/app/console/replay/playhead.h"
#include "kestrel/app/console/replay/recorded_autopilot.h"
#include "kestrel/app/console/replay/replay_frame.h"
#include "kestrel/app/console/replay/second_run.h"

namespace kestrel {

// The page's description of what a recording is searched for.
struct ReplaySubject {
  std::vector<SeriesDescription> series;  // values of the frames' samples
  std::vector<OverlayLayer> layers;       // layers that the shapes can have
  std::vector<ImageView> views;           // views beside the camera's image
  ConsoleOptionList options;  // options that the page may change, with the first run's values
  bool has_truth = false;     // the errors of the detections are known
};

// Interval of the checks for requests, and the shortest between two pictures.
inline constexpr Duration kLookInterval = std::chrono::milliseconds(20);

// Returns the description of a page that plays recordings, with the commands of RecordingPlayer.
ConsoleFeed::Description DescriptionOf(const std::string& title, const ReplaySubject& subject);

// Plays a recording with the results of one run of the detector, or of two runs with different
// options, as the users of a feed request. All functions are called by one thread, Follow often.
class RecordingPlayer {
 public:
  // Returns the image of a frame by its index. Throws InputError when it cannot be read.
  using ReadFrame = std::function<cv::Mat(std::size_t frame)>;
  // Access to the recording.
  struct Recording {
    // Opens the recording. Any thread.
    std::function<ReadFrame()> open;
    // Returns a job that runs the detector over the recording with these settings. Throws
    // InputError for settings that are not valid. Any thread.
    std::function<SecondRun::Job(const std::vector<std::string>& settings)> detect;
    // The reports of the autopilot up to then, where they were recorded.
    RecordedAutopilot autopilot = {};
  };

  // Begins with the first frame in which something was found. 'first': result of the first run, at
  // least one frame. 'feed' outlives the player. Throws InputError when the recording cannot be
  // opened.
  RecordingPlayer(const ReplaySubject& subject, ReplayResult first, Recording recording,
                  ConsoleFeed* feed);

  // Executes a command that concerns playing or the second run.
  void Obey(const ConsoleCommand& command);
  // Goes to the frame nearest to a time.
  void Seek(Time time);
  // Starts the second run. 'settings': what it differs by, for the page.
  void StartSecondRun(const std::vector<std::string>& settings, SecondRun::Job job);
  // Plays on, and reports what the second run and a clip have done meanwhile.
  void Follow();
  // Answers a request for a frame, a table or a clip. The answer is without content when there is
  // no such file.
  void AnswerExport(const PendingExport& pending);

 private:
  void FollowSecondRun();
  void EndSecondRun(SecondRun::Outcome outcome);
  void SendSecondRun(SecondRunState state, const std::string& error = "");
  void ShowFrame();
  void SendFrame();
  ExportAnswer MakeExport(const ExportRequest& request) const;
  Clip ClipOf(const ExportRequest& request) const;
  void SendTimeline();
  void SendSeries();
  std::vector<double> ValuesOf(const ReplayFrame& frame) const;

  bool has_truth_;
  ConsoleFeed* feed_;
  Recording recording_;
  ReadFrame read_;
  // second_ is null until the second run is done. A clip in the making shares ownership of its run.
  std::shared_ptr<const ReplayResult> first_, second_;
  std::vector<std::string> settings_;  // settings of the second run
  Time reported_{};                    // time of the last report of its progress
  ConsoleFrame picture_;
  Playhead playhead_;
  Time played_ = Now();  // time of the last call of Follow
  bool is_shown_ = false;
  SecondRun second_run_;
  ClipMaker clips_;
};

}  // namespace kestrel
