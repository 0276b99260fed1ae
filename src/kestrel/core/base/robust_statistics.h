// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Quantiles without sorting. Each function reorders the values that it is given (std::nth_element)
// and does not allocate; the values must not be empty unless documented otherwise.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <ranges>

namespace kestrel {

// Standard deviation of a normal distribution, in median magnitudes of its deviations:
// 1 / Phi^-1(3/4).
inline constexpr double kSigmaPerMedianMagnitude = 1.4826;

// Returns the value that 'rank' others would precede if 'values' were sorted.
template <std::ranges::random_access_range Values>
std::ranges::range_value_t<Values> RankedInPlace(Values&& values, std::size_t rank) {
  const auto place = std::ranges::begin(values) + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(std::ranges::begin(values), place, std::ranges::end(values));
  return *place;
}

// Returns the median; of an even number of values the upper one of the two in the middle.
template <std::ranges::random_access_range Values>
std::ranges::range_value_t<Values> MedianInPlace(Values&& values) {
  return RankedInPlace(values, std::ranges::size(values) / 2);
}

// Rank among n values, from 0, of the quantile 'share', 0 to 1.
enum class QuantileRank {
  kNearest,     // share * (n - 1), to the nearest
  kLower,       // share * (n - 1), rounded down
  kShareBelow,  // share * n, rounded down: that share of the values is below it
};

inline std::size_t RankOfQuantile(double share, std::size_t count, QuantileRank rank) {
  const std::size_t last = count - 1;
  switch (rank) {
    case QuantileRank::kNearest:
      return static_cast<std::size_t>(std::lround(share * static_cast<double>(last)));
    case QuantileRank::kLower:
      return static_cast<std::size_t>(share * static_cast<double>(last));
    case QuantileRank::kShareBelow:
      break;
  }
  return std::min(last, static_cast<std::size_t>(share * static_cast<double>(count)));
}

// Returns the quantile 'share', 0 to 1.
template <std::ranges::random_access_range Values>
std::ranges::range_value_t<Values> QuantileInPlace(Values&& values, double share,
                                                   QuantileRank rank) {
  return RankedInPlace(values, RankOfQuantile(share, std::ranges::size(values), rank));
}

// Returns the standard deviation of what has these magnitudes (absolute deviations), from their
// median: outliers do not count, as long as they are fewer than half. 0 without magnitudes.
template <std::ranges::random_access_range Magnitudes>
double RobustSigmaInPlace(Magnitudes&& magnitudes) {
  if (std::ranges::empty(magnitudes)) return 0;
  return kSigmaPerMedianMagnitude * static_cast<double>(MedianInPlace(magnitudes));
}

}  // namespace kestrel
