// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include <opencv2/core.hpp>

namespace kestrel {

enum class VideoFormat {
  kMp4,  // VP9 in MP4, which browsers play
  kAvi,  // motion JPEG in AVI, which every player plays, and ten times as large
};

// A video that is written, by GStreamer.
class VideoFile {
 public:
  // 'stem': its path without the extension; what is there is replaced. The rate is taken to what
  // players and containers want: from 1 to 240 Hz, in 1/100 Hz. Where GStreamer has no encoder for
  // MP4, it becomes an AVI.
  VideoFile(const std::string& stem, double rate_hz, VideoFormat format = VideoFormat::kMp4);
  ~VideoFile();
  VideoFile(const VideoFile&) = delete;
  VideoFile& operator=(const VideoFile&) = delete;

  // CV_8UC3, all of one size, at least 16 px each way. Throws InputError when there is no encoder,
  // or the file cannot be made, or not go on: the disk is full.
  void Write(const cv::Mat& image);

  // After the last image: the file is whole. Throws InputError when it cannot be. By the destructor
  // as well, which does not throw.
  void Close();

  // Empty before the first image.
  const std::string& path() const { return path_; }

 private:
  class Encoder;

  void Open(const cv::Size& size);
  bool OpenAs(VideoFormat format, const cv::Size& size);

  std::string stem_;
  double rate_hz_;
  VideoFormat format_;
  std::string path_;
  cv::Size size_;
  std::unique_ptr<Encoder> encoder_;
};

}  // namespace kestrel
