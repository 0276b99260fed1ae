// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <opencv2/core.hpp>

#include "kestrel/core/base/time.h"

namespace kestrel {

// How the pixels of a frame are stored.
enum class PixelFormat {
  kGray,  // CV_8UC1
  kBgr,   // CV_8UC3
};

// One image of a source.
struct Frame {
  std::string name;  // the image's path as it was given or lies below the source
  Time time;         // when its light was collected, on the clock of the images
  cv::Mat image;     // in the format that the source was asked for
};

}  // namespace kestrel
