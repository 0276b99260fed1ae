// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace kestrel {

// Factors for numbers that people read.
inline constexpr double kPercent = 100;
inline constexpr double kMilliseconds = 1000;  // per second

// Returns the quantile 'share' (0 to 1) of the values, by nearest rank; 'values' must not be empty.
inline double QuantileOf(std::vector<double> values, double share) {
  const auto last = static_cast<double>(values.size() - 1);
  const auto place = values.begin() + std::lround(share * last);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

inline double MedianOf(std::vector<double> values) {
  constexpr double kHalf = 0.5;
  return QuantileOf(std::move(values), kHalf);
}

}  // namespace kestrel
