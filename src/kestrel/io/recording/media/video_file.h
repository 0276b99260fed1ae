// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include <opencv2/core.hpp>

namespace kestrel {

enum class VideoFormat {
  kMp4,  // VP9 in MP4, which browsers play
  kAvi,  // motion JPEG in AVI, which all players play; ten times as large
};

// Writes a video by GStreamer.
class VideoFile {
 public:
  // 'stem': path without the extension; an existing file is replaced. The rate is limited to what
  // players and containers accept: 1 to 240 Hz, in steps of 1/100 Hz. If GStreamer has no encoder
  // for MP4, it writes an AVI.
  VideoFile(const std::string& stem, double rate_hz, VideoFormat format = VideoFormat::kMp4);
  ~VideoFile();
  VideoFile(const VideoFile&) = delete;
  VideoFile& operator=(const VideoFile&) = delete;

  // 'image': CV_8UC3, all of one size, at least 16 px each way. Throws InputError when there is no
  // encoder, or the file cannot be created or continued, as when the disk is full.
  void Write(const cv::Mat& image);

  // Completes the file after the last image. Throws InputError when that fails. The destructor does
  // the same without throwing.
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
