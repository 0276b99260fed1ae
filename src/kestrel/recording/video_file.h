// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>

namespace kestrel {

// A video that is written: .mp4, or .avi (motion JPEG) where OpenCV has no encoder for the first.
class VideoFile {
 public:
  // 'stem': its path without the extension; what is there is replaced. The rate is taken to what
  // players and containers want: from 1 to 240 Hz, in 1/100 Hz.
  VideoFile(const std::string& stem, double rate_hz);

  // CV_8UC3, all of one size. Throws InputError when there is no encoder, or the file cannot be
  // made.
  void Write(const cv::Mat& image);

  // After the last image: the file is whole. By the destructor as well.
  void Close() { writer_.release(); }

  // Empty before the first image.
  const std::string& path() const { return path_; }

 private:
  void Open(const cv::Size& size);

  std::string stem_;
  double rate_hz_;
  std::string path_;
  cv::Size size_;
  cv::VideoWriter writer_;
};

}  // namespace kestrel
