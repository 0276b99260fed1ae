// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <opencv2/core.hpp>

#include "kestrel/objects/cuboid_face.h"

namespace kestrel {

// A digit cut out, in black and white: 1 where it is, rows first, the middle of the digit in the
// middle, its size always the same.
inline constexpr int kDigitSide = 20;
using DigitImage = std::array<std::uint8_t, kDigitSide * kDigitSide>;

// The bright figure on the face with these corners (paper, section 3.6). The face is mapped to a
// square; of each pixel the least of its channels is taken, which is high for white and low for
// paint; the brightest part (Otsu's threshold) is the figure; it is centred and scaled by its first
// and second moments. Nothing when no 2 to 45 % of the face are clearly brighter than the rest.
std::optional<DigitImage> CutOutDigit(const cv::Mat& image, const FaceCorners& corners);

// Turned by a quarter.
DigitImage QuarterTurn(const DigitImage& digit);

}  // namespace kestrel
