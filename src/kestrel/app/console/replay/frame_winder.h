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

// Reads images of a source by index, even of a bag or a video that can only be read forward. It
// keeps the images that were read last, and reopens the source for earlier ones.
class FrameWinder {
 public:
  using Open = std::function<std::unique_ptr<FrameSource>()>;

  // 'open': opens the source at its beginning; it must give the same frames each time.
  explicit FrameWinder(Open open) : open_(std::move(open)) { Begin(); }
  FrameWinder(const FrameWinder&) = delete;
  FrameWinder& operator=(const FrameWinder&) = delete;

  // 'index': of an image of the source, those that cannot be read included. Throws InputError when
  // the image cannot be read or the source has fewer.
  cv::Mat Read(std::size_t index);

 private:
  static constexpr std::size_t kMaxKept = 100;

  void Begin();
  void Keep(const cv::Mat& image);

  Open open_;
  std::unique_ptr<FrameSource> source_;
  std::size_t next_ = 0;      // index of the source's next image
  std::deque<cv::Mat> kept_;  // the images before next_; empty where they cannot be read
};

}  // namespace kestrel
