// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

#include "kestrel/app/console/colors/color_session.h"
#include "kestrel/app/console/messages/console_feed.h"
#include "kestrel/core/base/bounded_queue.h"

namespace kestrel {

// The page that teaches colours: a ColorSession in one thread and the scoring of the models in
// another, so that neither the server nor a preview waits for scores.
class ColorPage {
 public:
  // Starts the threads. 'feed' outlives the page. Throws InputError as ColorSession does.
  ColorPage(ColorSource source, ConsoleFeed* feed);
  // Waits for the work in progress.
  ~ColorPage();
  ColorPage(const ColorPage&) = delete;
  ColorPage& operator=(const ColorPage&) = delete;

 private:
  // A copy of all inputs of ScoreColor.
  struct Exam {
    std::uint64_t revision = 0;
    std::size_t color = 0;
    ColorModel model;
    ColorGrid grid;
    std::vector<FrameMarks> marks;
  };

  void Serve();
  void Score();
  void Notify();

  ConsoleFeed* feed_;
  ColorSession session_;  // used by the thread of Serve only
  std::atomic<bool> is_stopped_{false};
  BoundedQueue<Exam> exams_{1};  // only the newest
  std::thread server_, scorer_;
};

}  // namespace kestrel
