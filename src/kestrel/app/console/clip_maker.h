// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <opencv2/core.hpp>

#include "kestrel/app/console/background_run.h"
#include "kestrel/app/console/console_feed.h"
#include "kestrel/app/console/export_request.h"

namespace kestrel {

// What a video shows.
struct Clip {
  // Gives the picture (CV_8UC3) of each of the clip's frames, from 0 and in order. Throws
  // InputError when it cannot.
  using Picture = std::function<cv::Mat(std::size_t index)>;

  // Called once, by the thread that makes the clip: images are read from a source of its own.
  std::function<Picture()> open;
  std::size_t frames = 0;  // at least one
  double rate_hz = 0;
  std::string name;  // that it is saved by, without the extension
};

// Makes clips, one at a time and by a thread of its own, as temporary files of bounded size, and
// tells the page how far it is. By one thread.
class ClipMaker {
 public:
  // 'feed' outlives the maker.
  explicit ClipMaker(ConsoleFeed* feed) : feed_(feed) {}

  // Is answered when the clip is made, or refused: at once when another one is under way.
  void Make(PendingExport pending, Clip clip);
  // Answers when it is time; ends what nobody waits for any more. Often.
  void Follow();

 private:
  using File = std::shared_ptr<const ExportFile>;

  void Tell(std::size_t done, std::size_t frames);

  ConsoleFeed* feed_;
  PendingExport pending_;
  std::string name_;
  std::size_t frames_ = 0;
  std::size_t told_ = 0;
  BackgroundRun<File> run_;
};

}  // namespace kestrel
