// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <utility>

#include <opencv2/core.hpp>

#include "kestrel/io/recording/frame_source.h"

namespace kestrel {

// Images of a source by their number, also of one that only goes forward, as a bag or a video: what
// was read last is kept, and for what is before that the source is opened anew.
class FrameWinder {
 public:
  using Open = std::function<std::unique_ptr<FrameSource>()>;

  // 'open': gives the source at its beginning, with the same frames each time.
  explicit FrameWinder(Open open) : open_(std::move(open)), source_(open_()) {}

  // Throws InputError when the image cannot be read, or there is none of this number.
  cv::Mat Read(std::size_t index);

 private:
  static constexpr std::size_t kMaxKept = 100;

  Open open_;
  std::unique_ptr<FrameSource> source_;
  std::size_t next_ = 0;      // that the source gives
  std::deque<cv::Mat> kept_;  // those before it
};

}  // namespace kestrel
