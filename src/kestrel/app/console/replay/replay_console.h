// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kestrel/app/console/calibration/calibration_page.h"
#include "kestrel/app/console/colors/color_page.h"
#include "kestrel/app/console/messages/console_feed.h"
#include "kestrel/app/console/replay/recording_player.h"
#include "kestrel/app/console/replay/replay_frame.h"
#include "kestrel/app/web_server/console_options.h"
#include "kestrel/app/web_server/web_server.h"

namespace kestrel {

// A recording on the page: a timeline and any of its frames with the results of one run of the
// detector, or of two runs with different options.
class ReplayConsole {
 public:
  using ReadFrame = RecordingPlayer::ReadFrame;
  using Recording = RecordingPlayer::Recording;

  // Starts the server. Throws InputError as WebServer does. 'colors': source for the page of
  // colours, if the recording has colours to teach.
  ReplayConsole(const ConsoleOptions& options, const std::string& title, ReplaySubject subject,
                std::optional<ColorSource> colors = std::nullopt);

  // As WebServer::urls.
  std::vector<std::string> urls() const { return server_.urls(); }

  // Shows the progress in words before there is anything to play.
  void SetProgress(const std::string& text) { feed_.Add(ViewStatus{"detecting", text, false}); }

  // Gives the page the tools to calibrate. Call it before Play.
  void OfferCalibration(CalibrationPage::Tools tools) { tools_ = std::move(tools); }

  // Plays the result of the first run (at least one frame) as the users request, until 'is_stopped'
  // returns true; it is called often. Call Play once only.
  void Play(ReplayResult first, Recording recording, const std::function<bool()>& is_stopped);

 private:
  void AnswerExport(const PendingExport& pending, RecordingPlayer* player) const;

  ReplaySubject subject_;
  ConsoleFeed feed_;
  WebServer server_;
  std::optional<ColorPage> colors_;
  CalibrationPage::Tools tools_;
  std::optional<CalibrationPage> calibration_;
};

}  // namespace kestrel
