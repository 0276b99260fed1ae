// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include <opencv2/videoio.hpp>

#include "kestrel/recording/frame_source.h"

namespace kestrel {

inline constexpr std::string_view kVideoDevice = "/dev/video";  // and its number

// Frames of a video file or of a camera, through cv::VideoCapture. A frame's name is the source's
// with the frame's number below it: "flight.mp4/000012".
class VideoSource : public FrameSource {
 public:
  // 'frame_count' as the container says it, 0 when that is not known or there is no end.
  VideoSource(const cv::VideoCapture& capture, std::string name, std::size_t frame_count);

  // The time is the stream's own (of a camera: the driver's) where it has one that increases, else
  // the time of the frame before and one period more. A container's count may be an estimate; a
  // video that ends more than 2 frames and 2 % before it is at fault.
  bool Next(Frame* frame) override;
  std::optional<std::size_t> frame_count() const override;
  double rate_hz() const override { return rate_hz_; }

 private:
  Time NextTime() const;
  void CheckEnd() const;

  cv::VideoCapture capture_;
  std::string name_;
  std::size_t frame_count_;
  double rate_hz_;
  std::size_t next_ = 0;
  Time last_time_;
};

// Throws InputError when the file has no video that can be decoded.
VideoSource OpenVideoFile(const std::string& path);

// 'camera': a device (/dev/video0) or a GStreamer pipeline. Throws InputError when it
// does not open.
VideoSource OpenCamera(const std::string& camera);

}  // namespace kestrel
