// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <limits>
#include <string>

#include <fmt/format.h>

namespace kestrel {

// A range of a quantity by which results are reported: low <= value < high, or the one value where
// both are the same.
struct Bin {
  double low;
  double high;

  bool Contains(double value) const { return value == low || (value > low && value < high); }
  // "2 to 6", "1" for one value, "14 and more" where it is open.
  std::string Label() const {
    if (low == high) return fmt::format("{:g}", low);
    return high == std::numeric_limits<double>::infinity() ? fmt::format("{:g} and more", low)
                                                           : fmt::format("{:g} to {:g}", low, high);
  }
};

// Heights of the camera above the pattern (m): those of the paper's Table 2, and higher.
inline constexpr std::array<Bin, 5> kAltitudeBins{
    {{0, 2}, {2, 6}, {6, 9}, {9, 14}, {14, std::numeric_limits<double>::infinity()}}};

}  // namespace kestrel
