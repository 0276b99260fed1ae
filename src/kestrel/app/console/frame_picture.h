// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/app/console/console_feed.h"

namespace kestrel {

// The image (8-bit gray or BGR) in colour, with the shapes drawn on it as on the page: what a
// second run found over the first run's shapes.
cv::Mat WithShapes(const cv::Mat& image, const std::vector<OverlayShape>& shapes);

}  // namespace kestrel
