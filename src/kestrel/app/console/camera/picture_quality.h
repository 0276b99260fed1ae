// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

namespace kestrel {

// Exposure and focus of the camera, measured in a picture.
struct PictureQuality {
  double brightness = 0;  // mean gray value, % of white
  double clipped = 0;     // part of the pixels that are black or white for good, %
  // Share of the contrast that lies between neighbouring pixels, %: the greater, the sharper. Only
  // pictures of the same scene compare.
  double sharpness = 0;
};

// 'gray': CV_8UC1, not empty.
PictureQuality MeasurePicture(const cv::Mat& gray);

}  // namespace kestrel
