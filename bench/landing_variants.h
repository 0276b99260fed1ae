// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include <opencv2/core.hpp>

#include "landing_frames.h"

namespace kestrel {

// A change of an image by another camera, exposure or transmission: the same scene, other pixels.
struct ImageVariant {
  std::string_view name;
  // 'image' and the result are CV_8UC1 of the same size. The same seed gives the same bytes.
  cv::Mat (*apply)(const cv::Mat& image, std::uint64_t seed);
};

// Returns all of them; the first changes nothing.
std::span<const ImageVariant> ImageVariants();

// Returns a set as seen in a mirror that swaps left and right, top and bottom, or both: images,
// camera and truth. The print is its own mirror image, and so is a lens without tangential
// distortion.
LandingFrameSet Mirrored(const LandingFrameSet& set, bool left_right, bool top_bottom);

}  // namespace kestrel
