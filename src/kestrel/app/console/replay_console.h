// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kestrel/app/console/calibration_page.h"
#include "kestrel/app/console/clip_maker.h"
#include "kestrel/app/console/color_page.h"
#include "kestrel/app/console/console_feed.h"
#include "kestrel/app/console/console_options.h"
#include "kestrel/app/console/playhead.h"
#include "kestrel/app/console/replay_frame.h"
#include "kestrel/app/console/second_run.h"
#include "kestrel/app/console/web_server.h"

namespace kestrel {

// The page's description of what a recording is searched for.
struct ReplaySubject {
  std::vector<SeriesDescription> series;  // values of the frames' samples
  std::vector<OverlayLayer> layers;       // layers that the shapes can have
  std::vector<ImageView> views;           // views beside the camera's image
  ConsoleOptionList options;  // options that the page may change, with the first run's values
  bool has_truth = false;     // the errors of the detections are known
};

// A recording on the page: a timeline and any of its frames with the results of one run of the
// detector, or of two runs with different options.
class ReplayConsole {
 public:
  // Returns the image of a frame by its index. Throws InputError when it cannot be read.
  using ReadFrame = std::function<cv::Mat(std::size_t frame)>;
  // Access to the recording.
  struct Recording {
    // Opens the recording. Any thread.
    std::function<ReadFrame()> open;
    // Returns a job that runs the detector over the recording with these settings. Throws
    // InputError for settings that are not valid.
    std::function<SecondRun::Job(const std::vector<std::string>& settings)> detect;
  };

  // Starts the server. Throws InputError as WebServer does. 'colors': source for the page of
  // colours, if the recording has colours to teach.
  ReplayConsole(const ConsoleOptions& options, const std::string& title, ReplaySubject subject,
                std::optional<ColorSource> colors = std::nullopt);

  std::string url() const { return server_.url(); }

  // Shows the progress in words before there is anything to play.
  void SetProgress(const std::string& text) { feed_.Add(ConsoleStatus{"detecting", text, false}); }

  // Gives the page the tools to calibrate. Call it before Play.
  void OfferCalibration(CalibrationPage::Tools tools) { tools_ = std::move(tools); }

  // Plays the result of the first run (at least one frame) as the users ask, until 'is_stopped'
  // returns true; it is called often. Call Play once only.
  void Play(ReplayResult first, Recording recording, const std::function<bool()>& is_stopped);

 private:
  void Obey(const ConsoleCommand& command);
  void StartSecondRun(const std::vector<std::string>& settings);
  void FollowSecondRun();
  void EndSecondRun(SecondRun::Outcome outcome);
  void TellSecondRun(SecondRunState state, const std::string& error = "");
  void ShowFrame();
  void TellFrame();
  void AnswerExport(const PendingExport& pending);
  ExportAnswer MakeExport(const ExportRequest& request) const;
  Clip ClipOf(const ExportRequest& request) const;
  void SendTimeline();
  // Returns the times since the first frame.
  std::vector<Duration> FrameTimes() const;

  ReplaySubject subject_;
  ConsoleFeed feed_;
  WebServer server_;
  std::optional<ColorPage> colors_;
  Recording recording_;
  ReadFrame read_;
  // second_ is null until the second run is done. A clip in the making shares ownership of its run.
  std::shared_ptr<const ReplayResult> first_, second_;
  std::vector<std::string> settings_;  // settings of the second run
  Time told_{};                        // time of the last report of its progress
  ConsoleFrame picture_;
  std::optional<Playhead> playhead_;
  bool is_shown_ = false;
  SecondRun second_run_;
  ClipMaker clips_;
  CalibrationPage::Tools tools_;
  std::optional<CalibrationPage> calibration_;
};

}  // namespace kestrel
