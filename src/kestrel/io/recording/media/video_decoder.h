// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include <opencv2/core.hpp>

#include "kestrel/core/base/time.h"
#include "kestrel/io/recording/media/gstreamer.h"

namespace kestrel {

// Gives the images of a GStreamer pipeline with an appsink, one after the other.
class VideoDecoder {
 public:
  // Waits for the first image. Throws InputError with the cause when none comes.
  explicit VideoDecoder(GstElementPointer pipeline);
  ~VideoDecoder();
  VideoDecoder(const VideoDecoder&) = delete;
  VideoDecoder& operator=(const VideoDecoder&) = delete;

  // Gives the next image (CV_8UC3) and its time in the stream, if it has one. Returns false at the
  // end; then fault() has the cause, if the stream should not have ended.
  bool Next(cv::Mat* image, std::optional<Time>* time);
  const std::string& fault() const { return fault_; }

  // Data of the container: images per second, 0 if unknown; number of images, 0 if unknown or
  // without an end.
  double rate_hz() const { return rate_hz_; }
  std::size_t frame_count() const { return frame_count_; }

 private:
  GstSamplePointer Pull();
  std::size_t RequestCount() const;

  GstElementPointer pipeline_;
  GstElementPointer sink_;
  GstWatch watch_;
  std::string fault_;
  GstSamplePointer first_;
  double rate_hz_ = 0;
  std::size_t frame_count_ = 0;
};

}  // namespace kestrel
