// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

#include "kestrel/vision/objects/color_grid.h"

namespace kestrel {

// The hue-saturation plane (paper, section 3.2): hue from left to right, saturation from bottom to
// top, brightest value of each; black where no cell of the grid has an object's label.
cv::Mat DrawHueSaturation(const ColorGrid& grid);

// A copy of the image (CV_8UC3) in which background is dark gray, what is ambiguous a lighter gray,
// and pixels of the objects' colours keep theirs.
cv::Mat DrawLabels(const cv::Mat& image, const ColorGrid& grid);

}  // namespace kestrel
