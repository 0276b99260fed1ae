// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>

#include <opencv2/core.hpp>

#include "kestrel/vision/objects/cuboid_face.h"

namespace kestrel {

// A digit cut out: 1 where it is, 0 where it is not, rows first, the middle of the digit in the
// middle, its width and height always the same.
inline constexpr int kDigitSide = 20;
using DigitImage = std::array<float, kDigitSide * kDigitSide>;

// The same with each side of its face taken for the foot: as it stands, and turned by one, two and
// three quarters. Each is unslanted: italics stand upright.
using DigitViews = std::array<DigitImage, 4>;

// The bright figure on the face with these corners (paper, section 3.6). The face is mapped to a
// square; of each pixel the least of its channels is taken, which is high for white and low for
// paint; the brightest part (Otsu's threshold) is the figure; it is centred, unslanted and scaled
// by its first and second moments. Nothing when no 2 to 45 % of the face are clearly brighter than
// the rest.
std::optional<DigitViews> CutOutDigit(const cv::Mat& image, const FaceCorners& corners);

}  // namespace kestrel
