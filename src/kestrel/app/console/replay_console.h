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

// What a recording is searched for, as far as the page is concerned.
struct ReplaySubject {
  std::vector<SeriesDescription> series;  // what the frames' samples hold
  std::vector<OverlayLayer> layers;       // of the shapes that there can be
  std::vector<ImageView> views;           // of the image
  ConsoleOptionList options;              // that the page may change, as of the first run
  bool has_truth = false;                 // errors are known
};

// A recording on the page: a timeline, and any frame of it with what was found, by one run of the
// detector or by two with different options.
class ReplayConsole {
 public:
  // Gives the image of a frame by its number. Throws InputError when it cannot.
  using ReadFrame = std::function<cv::Mat(std::size_t frame)>;
  // What the page takes from the recording.
  struct Recording {
    // Opens it; by any thread.
    std::function<ReadFrame()> open;
    // Gives what runs the detector over it once more with these settings. Throws InputError for
    // settings that are not valid.
    std::function<SecondRun::Job(const std::vector<std::string>& settings)> detect;
  };

  // Serves from now on. Throws InputError as WebServer does. 'colors': what colours are taught by,
  // when the recording has any.
  ReplayConsole(const ConsoleOptions& options, const std::string& title, ReplaySubject subject,
                std::optional<ColorSource> colors = std::nullopt);

  std::string url() const { return server_.url(); }

  // What is done before there is something to play, in words.
  void SetProgress(const std::string& text) { feed_.Add(ConsoleStatus{"detecting", text, false}); }

  // The page calibrates by these. Before Play.
  void OfferCalibration(CalibrationPage::Tools tools) { tools_ = std::move(tools); }

  // Plays what the first run came to, at least one frame, as the users ask, until 'is_stopped',
  // which is asked often. Once only.
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
  // Since the first.
  std::vector<Duration> FrameTimes() const;

  ReplaySubject subject_;
  ConsoleFeed feed_;
  WebServer server_;
  std::optional<ColorPage> colors_;
  Recording recording_;
  ReadFrame read_;
  // The second when it is done. A clip that is made keeps what it shows.
  std::shared_ptr<const ReplayResult> first_, second_;
  std::vector<std::string> settings_;  // of the second run
  Time told_{};                        // how far it is
  ConsoleFrame picture_;
  std::optional<Playhead> playhead_;
  bool is_shown_ = false;
  SecondRun second_run_;
  ClipMaker clips_;
  CalibrationPage::Tools tools_;
  std::optional<CalibrationPage> calibration_;
};

}  // namespace kestrel
