// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <opencv2/core.hpp>

#include "kestrel/base/time.h"

namespace kestrel {

// One image of a source.
struct Frame {
  std::string name;  // the image's path as it was given or lies below the source
  Time time;         // when its light was collected, on the clock of the images
  cv::Mat image;     // CV_8UC1
};

}  // namespace kestrel
