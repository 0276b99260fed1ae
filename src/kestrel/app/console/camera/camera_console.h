// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/app/console/camera/lens_page.h"
#include "kestrel/app/console/messages/console_feed.h"
#include "kestrel/app/web_server/console_options.h"
#include "kestrel/app/web_server/web_server.h"
#include "kestrel/core/base/time.h"
#include "kestrel/flight/session/live_source.h"
#include "kestrel/io/recording/frame.h"

namespace kestrel {

// A camera on the page, before anything is known of it: its picture, rate, exposure and focus, and
// the guided calibration of its lens. A camera that is missing or fails is opened again and again.
// Without a page it only keeps the camera running.
class CameraConsole {
 public:
  struct Camera {
    std::string name;              // as the user gave it
    LiveSource* source = nullptr;  // it, where it is open already
    // Opens it; valid until it is opened again. Throws InputError with the reason if it cannot be
    // opened.
    std::function<LiveSource*()> open;
    // Returns the exposure, s, if the camera reports it.
    std::function<std::optional<double>()> exposure_s;
    // Keeps a picture; returns a sentence that names its place. Throws InputError.
    std::function<std::string(const cv::Mat& image, Time captured)> keep_snapshot;
    // Switches recording on or off; returns a sentence for the user about it. Throws InputError.
    std::function<std::string(bool is_on)> record;
    std::function<bool()> is_recording;
    // Called with each new fault of the camera.
    std::function<void(const std::string& fault)> notify;
  };

  // Starts the server; without 'page' there is none. Throws InputError as WebServer does.
  CameraConsole(const std::optional<ConsoleOptions>& page, Camera camera, const std::string& folder,
                const LandingPatternDetectorOptions& detector);

  // As WebServer::urls; empty without a page.
  std::vector<std::string> urls() const {
    return server_ ? server_->urls() : std::vector<std::string>();
  }

  // Shows the camera until 'is_stopped' returns true; it is called often.
  void Play(const std::function<bool()>& is_stopped);

  // Shows an event. Any thread.
  void Report(EventLevel level, const std::string& text) {
    feed_.Add(SessionEvent{Now(), level, text});
  }

 private:
  void Obey(const ConsoleCommand& command);
  std::string Snapshot() const;
  void Open();
  void Watch();
  void Take(const Frame& frame);
  void AddSample(const cv::Mat& gray);
  void SetFault(const std::string& fault);
  void ReportState();
  void ReportAge();

  Camera camera_;
  ConsoleFeed feed_;
  std::optional<WebServer> server_;
  LensPage lens_;
  LiveSource* source_;  // null: to be opened
  Time next_attempt_{};
  std::string fault_;    // fault of the camera; empty: none
  ViewStatus reported_;  // the last status that the page got
  ConsoleFrame frame_;   // the newest
  Time measured_{}, aged_{};
  int frames_ = 0;  // since then
  double best_sharpness_ = 0;
};

}  // namespace kestrel
