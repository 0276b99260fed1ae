// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kestrel/console/calibration_page.h"
#include "kestrel/console/color_page.h"
#include "kestrel/console/console_feed.h"
#include "kestrel/console/console_options.h"
#include "kestrel/console/replay_frame.h"
#include "kestrel/console/second_run.h"
#include "kestrel/console/web_server.h"

namespace kestrel {

// A recording on the page: a timeline, and any frame of it with what was found, by one run of the
// detector or by two with different options.
class ReplayConsole {
 public:
  // Gives the image of a frame by its number. Throws InputError when it cannot.
  using ReadFrame = std::function<cv::Mat(std::size_t frame)>;
  // Runs the detector over the recording once more, by a thread of its own.
  using Detect = std::function<std::optional<ReplayResult>(const LandingPipelineOptions& options,
                                                           const SecondRun::GoOn& go_on)>;

  // Serves from now on. 'has_truth': errors are known. Throws InputError as WebServer does.
  // 'used': the options of the first run. 'colors': what colours are taught by, when the recording
  // has any.
  ReplayConsole(const ConsoleOptions& options, const std::string& title,
                const LandingPipelineOptions& used, bool has_truth,
                std::optional<ColorSource> colors = std::nullopt);

  std::string url() const { return server_.url(); }

  // What is done before there is something to play, in words.
  void SetProgress(const std::string& text) { feed_.Add(ConsoleStatus{"detecting", text, false}); }

  // The page calibrates by these. Before Play.
  void OfferCalibration(CalibrationPage::Tools tools) { tools_ = std::move(tools); }

  // Plays what the first run came to, at least one frame, as the users ask, until 'is_stopped',
  // which is asked often. Once only.
  void Play(ReplayResult first, ReadFrame read, Detect detect,
            const std::function<bool()>& is_stopped);

 private:
  void Obey(const ConsoleCommand& command);
  void StartSecondRun(const std::vector<std::string>& settings);
  void FollowSecondRun();
  void EndSecondRun(SecondRun::Outcome outcome);
  void TellSecondRun(SecondRunState state, const std::string& error = "");
  void Advance(Duration elapsed);
  void GoTo(std::size_t frame);
  void ShowFrame();
  std::vector<OverlayShape> ShapesOf(std::size_t frame) const;
  ExportAnswer MakeExport(const ExportRequest& request) const;
  void SendTimeline();
  double SecondsOf(std::size_t frame) const;  // since the first
  std::size_t NearestFrame(double seconds) const;

  LandingPipelineOptions used_;
  bool has_truth_;
  ConsoleFeed feed_;
  WebServer server_;
  std::optional<ColorPage> colors_;
  std::optional<LandingView> view_;
  std::vector<ReplayFrame> frames_;
  std::string table_;
  ReadFrame read_;
  Detect detect_;
  std::vector<std::string> settings_;   // of the second run
  std::optional<ReplayResult> second_;  // when it is done
  Time told_{};                         // how far it is
  ConsoleFrame picture_;
  std::size_t frame_ = 0;  // that is shown
  double position_s_ = 0;  // since the first frame
  double speed_ = 0;
  bool is_shown_ = false;
  SecondRun second_run_;
  CalibrationPage::Tools tools_;
  std::optional<CalibrationPage> calibration_;
};

}  // namespace kestrel
