// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include <opencv2/core.hpp>

#include "kestrel/io/recording/output_folder.h"

namespace kestrel {

// Destination of frames with drawings on them (CV_8UC3).
class AnnotatedWriter {
 public:
  virtual ~AnnotatedWriter() = default;
  // Throws InputError when the image cannot be written.
  virtual void Write(const std::string& frame_name, const cv::Mat& image) = 0;
};

// Writes annotated/<name of the frame>.png. 'folder' must outlive the writer.
std::unique_ptr<AnnotatedWriter> MakeImageWriter(const OutputFolder& folder);

// Writes 'name'.mp4, or 'name'.avi (motion JPEG) when GStreamer has no encoder for MP4.
std::unique_ptr<AnnotatedWriter> MakeVideoWriter(const OutputFolder& folder, double rate_hz,
                                                 const std::string& name = "annotated");

}  // namespace kestrel
