// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <opencv2/core.hpp>

#include "kestrel/app/console/background_run.h"
#include "kestrel/app/console/messages/console_feed.h"
#include "kestrel/app/console/messages/export_request.h"

namespace kestrel {

// The content of a video.
struct Clip {
  // Returns the picture (CV_8UC3) of a frame of the clip. It is called for each index from 0, in
  // order. Throws InputError when there is no picture.
  using Picture = std::function<cv::Mat(std::size_t index)>;

  // Called once, by the thread that makes the clip: it reads images from a source of its own.
  std::function<Picture()> open;
  std::size_t frames = 0;  // at least one
  double rate_hz = 0;
  std::string name;  // file name without the extension
};

// Makes clips as temporary files of limited size, one at a time in a thread of its own, and tells
// the page the progress. Call it from one thread.
class ClipMaker {
 public:
  // 'feed' outlives the maker.
  explicit ClipMaker(ConsoleFeed* feed) : feed_(feed) {}

  // Starts a clip. The request is answered when the clip is made or refused; it is refused at once
  // while another clip is being made.
  void Make(PendingExport pending, Clip clip);
  // Answers a finished clip and cancels one that nobody waits for any more. Call it often.
  void Follow();

 private:
  using File = std::shared_ptr<const ExportFile>;

  void Notify(std::size_t done, std::size_t frames);

  ConsoleFeed* feed_;
  PendingExport pending_;
  std::string name_;
  std::size_t frames_ = 0;
  std::size_t reported_ = 0;
  BackgroundRun<File> run_;
};

}  // namespace kestrel
