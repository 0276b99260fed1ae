// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/recording/video_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>

#include "kestrel/base/error.h"

namespace kestrel {

VideoFile::VideoFile(const std::string& stem, double rate_hz)
    : stem_(stem), rate_hz_(std::round(std::clamp(rate_hz, 1.0, 240.0) * 100) / 100) {}

void VideoFile::Write(const cv::Mat& image) {
  if (!writer_.isOpened()) Open(image.size());
  if (image.size() != size_) throw InputError(path_ + ": expected images of one size");
  writer_.write(image);
}

void VideoFile::Open(const cv::Size& size) {
  size_ = size;
  path_ = stem_ + ".mp4";
  // OpenCV would try one encoder after the other, and say so on the terminal.
  const std::filesystem::path folder = std::filesystem::absolute(path_).parent_path();
  if (!std::filesystem::is_directory(folder)) {
    throw InputError(path_ + ": cannot be written: there is no folder " + folder.string());
  }
  if (writer_.open(path_, cv::VideoWriter::fourcc('m', 'p', '4', 'v'), rate_hz_, size)) return;
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
  path_ = stem_ + ".avi";
  if (writer_.open(path_, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), rate_hz_, size)) return;
  throw InputError(path_ + ": cannot be written; images (--annotate=images) need no encoder");
}

}  // namespace kestrel
