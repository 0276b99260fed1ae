// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/console/console_feed.h"
#include "kestrel/console/console_options.h"
#include "kestrel/console/landing_view.h"
#include "kestrel/console/web_server.h"

namespace kestrel {

// What became of a frame of a recording.
struct ReplayFrame {
  LandingObservation observation;
  FrameMark mark = FrameMark::kNothing;
  std::optional<double> error_px;  // of the detected centre, where the truth is known
};

// The marks of frames whose truth is not known: lost are those without the pattern between two with
// it, false those that the track does not take.
void MarkByTrack(std::vector<ReplayFrame>* frames);

// A recording on the page: a timeline, and any frame of it with what was found.
class ReplayConsole {
 public:
  // Gives the image of a frame by its number. Throws InputError when it cannot.
  using ReadFrame = std::function<cv::Mat(std::size_t frame)>;

  // Serves from now on. 'has_truth': errors are known. Throws InputError as WebServer does.
  ReplayConsole(const ConsoleOptions& options, const std::string& title, LandingView view,
                bool has_truth);

  std::string url() const { return server_.url(); }

  // What is done before there is something to play, in words.
  void SetProgress(const std::string& text) { feed_.Add(ConsoleStatus{"detecting", text, false}); }

  // Plays 'frames', in order of time and at least one, as the users ask, until 'is_stopped', which
  // is asked often. Once only.
  void Play(std::vector<ReplayFrame> frames, ReadFrame read,
            const std::function<bool()>& is_stopped);

 private:
  void Obey(const ConsoleCommand& command);
  void Advance(Duration elapsed);
  void GoTo(std::size_t frame);
  void ShowFrame();
  void SendTimeline();
  double SecondsOf(std::size_t frame) const;  // since the first
  std::size_t NearestFrame(double seconds) const;

  LandingView view_;
  bool has_truth_;
  ConsoleFeed feed_;
  WebServer server_;
  std::vector<ReplayFrame> frames_;
  ReadFrame read_;
  ConsoleFrame picture_;
  std::size_t frame_ = 0;  // that is shown
  double position_s_ = 0;  // since the first frame
  double speed_ = 0;
  bool is_shown_ = false;
};

}  // namespace kestrel
