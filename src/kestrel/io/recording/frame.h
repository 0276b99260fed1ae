// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
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
struct Frame {
  std::string name;        // path of the image, as given or relative to the source
  Time time;               // middle of the exposure, on the clock of the images
  cv::Mat image;           // in the format that was requested of the source
  cv::Mat color{};         // the same in colour, CV_8UC3, where the source keeps it; else empty
  std::size_t camera = 0;  // index of the camera among those of the source
};

}  // namespace kestrel
