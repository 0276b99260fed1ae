// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/app/console/messages/console_feed.h"

namespace kestrel {

// Returns the image (8-bit gray or BGR) as BGR with the shapes drawn as on the page; the shapes of
// a second run lie over those of the first.
cv::Mat WithShapes(const cv::Mat& image, const std::vector<OverlayShape>& shapes);

}  // namespace kestrel
