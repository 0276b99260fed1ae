// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/calibration/color_training/marked_pixels.h"
#include "kestrel/core/base/time.h"

namespace kestrel {

// Frames of a live camera that a user keeps, to teach colours by: images in a folder, which
// `kestrel console` opens as any other folder of images. By one thread.
class KeptFrames {
 public:
  static constexpr std::size_t kMost = MarkedPixels::kMaxFrames;

  // 'folder' does not exist; it is made with the first frame.
  explicit KeptFrames(std::filesystem::path folder) : folder_(std::move(folder)) {}

  // Keeps the image as it is, CV_8UC3, with the time of its capture in its name. Returns what was
  // done, in words. Throws InputError when that cannot be done, or there are kMost already: none is
  // ever replaced.
  std::string Keep(const cv::Mat& image, Time captured);

  // The frame, by its number from 0. Throws InputError when it cannot be read.
  cv::Mat Read(std::size_t frame) const;

 private:
  std::filesystem::path folder_;
  std::vector<std::string> files_;
};

}  // namespace kestrel
