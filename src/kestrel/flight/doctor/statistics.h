// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>
#include <vector>

#include "kestrel/core/base/robust_statistics.h"

namespace kestrel {

// Factors for numbers that people read.
inline constexpr double kPercent = 100;
inline constexpr double kMilliseconds = 1000;  // per second

// Returns the quantile 'share' (0 to 1) of the values, by nearest rank; 'values' must not be empty.
inline double QuantileOf(std::vector<double> values, double share) {
  return QuantileInPlace(values, share, QuantileRank::kNearest);
}

inline double MedianOf(std::vector<double> values) {
  constexpr double kHalf = 0.5;
  return QuantileOf(std::move(values), kHalf);
}

}  // namespace kestrel
