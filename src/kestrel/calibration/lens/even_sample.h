// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/calibration/lens/lens_calibration.h"

namespace kestrel {

// Evenly spaced images of a stream of any length: at most 400.
class EvenSample {
 public:
  // Copies the pixels of an image that it keeps. 'name': for messages of the calibration.
  void Add(const std::string& name, const cv::Mat& image);
  std::vector<LensImage> Take() { return std::move(images_); }

 private:
  std::vector<LensImage> images_;
  std::size_t count_ = 0;
  std::size_t stride_ = 1;
};

}  // namespace kestrel
