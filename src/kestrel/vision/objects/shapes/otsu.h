// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

namespace kestrel {

using Histogram = std::array<int, 256>;

// A threshold ('lower' values are at most 'threshold') and the means of both sides.
struct OtsuSplit {
  int threshold = 255;
  double lower_mean = 0;
  double upper_mean = 0;
};

// Returns the threshold with the largest variance between its two sides (Otsu 1979). With fewer
// than two different values the upper mean is 0.
OtsuSplit SplitByOtsu(const Histogram& histogram);

}  // namespace kestrel
