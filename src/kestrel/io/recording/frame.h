// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <opencv2/core.hpp>

#include "kestrel/core/base/time.h"

namespace kestrel {

// Storage of a frame's pixels.
enum class PixelFormat {
  kGray,  // CV_8UC1
  kBgr,   // CV_8UC3
};

// An image of a source.
//
// Example:
//   const Frame frame{.name = "cam0/0001.png", .time = Now(), .image = image};
//   std::cout << frame.name << ": " << frame.image.cols << " x " << frame.image.rows << "\n";
struct Frame {
  std::string name;  // path of the image, as given or relative to the source
  Time time;         // middle of the exposure, on the clock of the images
  cv::Mat image;     // in the format that was requested of the source
};

}  // namespace kestrel
