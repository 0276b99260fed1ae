// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

#include "kestrel/vision/objects/color/color_grid.h"

namespace kestrel {

// Draws the hue-saturation plane (paper, section 3.2): hue from left to right, saturation from
// bottom to top, each at its brightest value. It is black where no cell of the grid has the label
// of an object.
cv::Mat DrawHueSaturation(const ColorGrid& grid);

// Returns a copy of the image (CV_8UC3) in which background is dark gray and ambiguous pixels are
// lighter gray; pixels of the objects' colours are unchanged.
cv::Mat DrawLabels(const cv::Mat& image, const ColorGrid& grid);

}  // namespace kestrel
