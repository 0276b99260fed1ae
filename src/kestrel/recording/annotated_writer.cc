// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/recording/annotated_writer.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include "kestrel/base/error.h"

namespace kestrel {
namespace {

class ImageWriter : public AnnotatedWriter {
 public:
  explicit ImageWriter(const OutputFolder& folder) : folder_(folder) {}

  void Write(const std::string& frame_name, const cv::Mat& image) override {
    std::filesystem::path name = "annotated" / std::filesystem::path(frame_name).relative_path();
    const std::string path = folder_.NewFile(name.replace_extension(".png")).string();
    if (!cv::imwrite(path, image)) throw InputError(path + ": cannot be written");
  }

 private:
  const OutputFolder& folder_;
};

class VideoWriter : public AnnotatedWriter {
 public:
  // Players and containers want a rate of this range, in 1/100 Hz.
  VideoWriter(const OutputFolder& folder, double rate_hz)
      : mp4_(folder.NewFile("annotated.mp4").string()),
        avi_(folder.NewFile("annotated.avi").string()),
        rate_hz_(std::round(std::clamp(rate_hz, 1.0, 240.0) * 100) / 100) {}

  void Write(const std::string& /*frame_name*/, const cv::Mat& image) override {
    if (!writer_.isOpened()) Open(image.size());
    writer_.write(image);
  }

 private:
  void Open(const cv::Size& size) {
    if (writer_.open(mp4_, cv::VideoWriter::fourcc('m', 'p', '4', 'v'), rate_hz_, size)) return;
    std::error_code ignored;
    std::filesystem::remove(mp4_, ignored);
    if (writer_.open(avi_, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), rate_hz_, size)) return;
    throw InputError(avi_ + ": cannot be written; --annotate=images needs no encoder");
  }

  std::string mp4_;
  std::string avi_;
  double rate_hz_;
  cv::VideoWriter writer_;
};

}  // namespace

std::unique_ptr<AnnotatedWriter> MakeImageWriter(const OutputFolder& folder) {
  return std::make_unique<ImageWriter>(folder);
}

std::unique_ptr<AnnotatedWriter> MakeVideoWriter(const OutputFolder& folder, double rate_hz) {
  return std::make_unique<VideoWriter>(folder, rate_hz);
}

}  // namespace kestrel
