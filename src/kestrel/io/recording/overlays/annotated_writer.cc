// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/overlays/annotated_writer.h"

#include <filesystem>

#include "kestrel/core/codec/image_codec.h"
#include "kestrel/io/recording/media/video_file.h"

namespace kestrel {
namespace {

class ImageWriter : public AnnotatedWriter {
 public:
  explicit ImageWriter(const OutputFolder& folder) : folder_(folder) {}

  void Write(const std::string& frame_name, const cv::Mat& image) override {
    std::filesystem::path name = "annotated" / std::filesystem::path(frame_name).relative_path();
    const std::string path = folder_.NewFile(name.replace_extension(".png")).string();
    WriteImage(path, image);
  }

 private:
  const OutputFolder& folder_;
};

class VideoWriter : public AnnotatedWriter {
 public:
  // Neither file may exist: only with the first frame is it known which of the two it becomes.
  VideoWriter(const OutputFolder& folder, double rate_hz, const std::string& name)
      : video_(folder.NewFile(name + ".mp4").replace_extension().string(), rate_hz) {
    folder.NewFile(name + ".avi");
  }

  void Write(const std::string& /*frame_name*/, const cv::Mat& image) override {
    video_.Write(image);
  }

 private:
  VideoFile video_;
};

}  // namespace

std::unique_ptr<AnnotatedWriter> MakeImageWriter(const OutputFolder& folder) {
  return std::make_unique<ImageWriter>(folder);
}

std::unique_ptr<AnnotatedWriter> MakeVideoWriter(const OutputFolder& folder, double rate_hz,
                                                 const std::string& name) {
  return std::make_unique<VideoWriter>(folder, rate_hz, name);
}

}  // namespace kestrel
