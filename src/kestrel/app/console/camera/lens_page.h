// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/app/console/background_run.h"
#include "kestrel/app/console/messages/console_feed.h"
#include "kestrel/app/console/messages/lens_state.h"
#include "kestrel/calibration/lens/lens_calibration.h"
#include "kestrel/calibration/lens/lens_guide.h"
#include "kestrel/core/base/time.h"
#include "kestrel/vision/landing/landing_pattern_detector.h"

namespace kestrel {

// The part of the page that calibrates the lens of a live camera: it takes views of the board by
// itself, advises what to show next, and saves the result. All functions are called by one thread,
// which never waits for the search of the board or the estimation.
class LensPage {
 public:
  struct Options {
    std::string camera;                      // as the user named it, for the next command
    std::string folder;                      // where a calibration is saved
    LandingPatternDetectorOptions detector;  // detector options for Kestrel's own print
  };

  // 'feed' outlives the page.
  LensPage(Options options, ConsoleFeed* feed);

  // Executes a command that concerns the lens.
  void Obey(const ConsoleCommand& command);
  // Searches the image (CV_8UC1) for the board, unless another is being searched.
  void Look(const cv::Mat& gray, Time captured);
  // Takes the results of the search and the estimation. Call it often.
  void Follow();
  // The board where it was seen last.
  const std::vector<OverlayShape>& shapes() const { return shapes_; }

 private:
  void Begin(const std::vector<std::string>& words);
  void Stop();
  void Save(const std::vector<std::string>& words);
  void TakeSight(std::optional<LensView> view);
  void Estimate();
  void TakeEstimate(BackgroundRun<LensCalibration>::Outcome outcome);
  void Notify();

  Options options_;
  ConsoleFeed* feed_;
  std::optional<LensBoard> board_;
  std::optional<DistortionModel> model_;
  std::optional<LensGuide> guide_;  // guide for the images' size
  cv::Size size_;
  CameraIntrinsics camera_;    // the best guess so far
  std::size_t guess_ = 0;      // index in LensGuesses while Kestrel's own print is not found
  std::size_t estimated_ = 0;  // views of the last estimation
  std::optional<LensCalibration> result_;
  std::vector<OverlayShape> shapes_;
  Time searched_{};  // capture of the image that is searched
  ConsoleLens state_;
  BackgroundRun<LensView> search_;
  BackgroundRun<LensCalibration> estimation_;
};

// Returns the word as a shell takes it: in quotes where it must be.
std::string ShellWord(const std::string& word);

}  // namespace kestrel
