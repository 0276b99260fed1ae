// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/app/console/console_feed.h"
#include "kestrel/app/console/console_options.h"
#include "kestrel/app/console/lens_page.h"
#include "kestrel/app/console/web_server.h"
#include "kestrel/core/base/time.h"
#include "kestrel/flight/session/live_source.h"
#include "kestrel/io/recording/frame.h"

namespace kestrel {

// A camera on the page, before anything is known of it: its picture, rate, exposure and focus, and
// the guided calibration of its lens. A camera that is missing or fails is opened again and again.
class CameraConsole {
 public:
  struct Camera {
    std::string name;  // as the user gave it
    // Opens it; valid until it is opened again. Throws InputError that says why it cannot be.
    std::function<LiveSource*()> open;
    // Returns the exposure, s, where the camera tells it.
    std::function<std::optional<double>()> exposure_s;
    // Keeps a picture; returns a sentence that says where. Throws InputError.
    std::function<std::string(const cv::Mat& image, Time captured)> keep_snapshot;
    // Called with each new fault of the camera.
    std::function<void(const std::string& fault)> tell;
  };

  // Starts the server. Throws InputError as WebServer does.
  CameraConsole(const ConsoleOptions& options, Camera camera, const std::string& folder,
                const LandingPatternDetectorOptions& detector);

  std::vector<std::string> urls() const { return server_.urls(); }

  // Shows the camera until 'is_stopped' returns true; it is called often.
  void Play(const std::function<bool()>& is_stopped);

 private:
  void Obey(const ConsoleCommand& command);
  void Snapshot();
  void Open();
  void Watch();
  void Take(const Frame& frame);
  void AddSample(const cv::Mat& gray);
  void TellState(const std::string& fault);
  void TellAge();

  Camera camera_;
  ConsoleFeed feed_;
  WebServer server_;
  LensPage lens_;
  LiveSource* source_ = nullptr;  // null: to be opened
  Time next_attempt_{};
  std::optional<std::string> fault_;  // that was told
  ConsoleFrame frame_;                // the newest
  Time measured_{}, aged_{};
  int frames_ = 0;  // since then
  double best_sharpness_ = 0;
};

}  // namespace kestrel
