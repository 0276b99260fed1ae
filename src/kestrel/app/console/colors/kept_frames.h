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

// Frames of a live camera that a user keeps to teach colours: image files in a folder, which
// `kestrel console` opens like any other folder of images. Call it from one thread.
class KeptFrames {
 public:
  static constexpr std::size_t kMost = MarkedPixels::kMaxFrames;

  // 'folder' must not exist yet; it is created with the first frame.
  explicit KeptFrames(std::filesystem::path folder) : folder_(std::move(folder)) {}

  // Saves the image (CV_8UC3) unchanged, with the time of its capture in its file name. Returns a
  // sentence that names the frame and its file. Throws InputError when it cannot be saved, or when
  // there are kMost frames already: frames are never replaced.
  std::string Keep(const cv::Mat& image, Time captured);

  // Reads a frame by its index, from 0. Throws InputError when it cannot be read.
  cv::Mat Read(std::size_t frame) const;

 private:
  std::filesystem::path folder_;
  std::vector<std::string> files_;
};

}  // namespace kestrel
