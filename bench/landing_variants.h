// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include <opencv2/core.hpp>

#include "landing_frames.h"

namespace kestrel {

// What another camera, exposure or transmission makes of an image: the same scene, other pixels.
struct ImageVariant {
  std::string_view name;
  // 'image' and the result: CV_8UC1 of one size. The same seed gives the same bytes.
  cv::Mat (*apply)(const cv::Mat& image, std::uint64_t seed);
};

// All of them; the first changes nothing.
std::span<const ImageVariant> ImageVariants();

// A set as seen in a mirror that swaps left and right, or top and bottom, or both: images, camera
// and truth. The print is its own mirror image, and so is the lens: without tangential distortion.
LandingFrameSet Mirrored(const LandingFrameSet& set, bool left_right, bool top_bottom);

}  // namespace kestrel
