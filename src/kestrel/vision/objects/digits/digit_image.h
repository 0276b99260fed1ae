// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>

#include <opencv2/core.hpp>

#include "kestrel/vision/objects/shapes/cuboid_face.h"

namespace kestrel {

// A normalized image of a digit: 1 on the digit, 0 elsewhere, row by row. The digit is centred and
// has always the same width and height.
inline constexpr int kDigitSide = 20;
using DigitImage = std::array<float, kDigitSide * kDigitSide>;

// The digit with each side of its face taken for the foot: unturned, and turned by one, two and
// three quarters. Each view is unslanted, so that italics are upright.
using DigitViews = std::array<DigitImage, 4>;

// Extracts the bright figure on the face with these corners (paper, section 3.6). The face is
// mapped to a square. The value of a pixel is the least of its channels, which is high for white
// and low for paint. The brightest part (Otsu's threshold) is the figure. It is centred, unslanted
// and scaled by its first and second moments. Returns nothing unless 2 to 45 % of the face is
// clearly brighter than the rest.
std::optional<DigitViews> CutOutDigit(const cv::Mat& image, const FaceCorners& corners);

}  // namespace kestrel
