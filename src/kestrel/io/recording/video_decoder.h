// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include <opencv2/core.hpp>

#include "kestrel/core/base/time.h"
#include "kestrel/io/recording/gstreamer.h"

namespace kestrel {

// The images of a pipeline of GStreamer that ends in an appsink, one after the other.
class VideoDecoder {
 public:
  // Waits for the first image. Throws InputError with what went wrong when none comes.
  explicit VideoDecoder(GstElementPointer pipeline);
  ~VideoDecoder();
  VideoDecoder(const VideoDecoder&) = delete;
  VideoDecoder& operator=(const VideoDecoder&) = delete;

  // The next image (CV_8UC3) and its time in the stream, where it has one; false at the end, after
  // which fault() says why if it should not have ended.
  bool Next(cv::Mat* image, std::optional<Time>* time);
  const std::string& fault() const { return fault_; }

  // What the container says: images a second, 0 where it does not; how many there are, 0 where it
  // does not, or there is no end.
  double rate_hz() const { return rate_hz_; }
  std::size_t frame_count() const { return frame_count_; }

 private:
  GstSamplePointer Pull();
  std::size_t AskForCount() const;

  GstElementPointer pipeline_;
  GstElementPointer sink_;
  GstWatch watch_;
  std::string fault_;
  GstSamplePointer first_;
  double rate_hz_ = 0;
  std::size_t frame_count_ = 0;
};

}  // namespace kestrel
