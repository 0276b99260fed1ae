// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>

namespace kestrel {

// Logarithms of gray values, from 0 to 1. A shadow divides the light; what it takes from a
// logarithm is the same on black and on white, so that the contrast of a print stays.
class LogGrays {
 public:
  LogGrays() {
    constexpr double kDarkest = 16;  // below it is mostly noise and stray light
    for (int gray = 0; gray < 256; ++gray) {
      values_[gray] = static_cast<float>(std::log1p(gray / kDarkest) / std::log1p(255 / kDarkest));
    }
  }
  // 'gray': 0 to 255, rounded down.
  float operator()(float gray) const { return values_[static_cast<int>(gray)]; }

 private:
  std::array<float, 256> values_;
};

}  // namespace kestrel
