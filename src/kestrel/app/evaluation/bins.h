// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <limits>
#include <string>

#include <fmt/format.h>

namespace kestrel {

// A range of a quantity by which results are grouped: low <= value < high, or exactly one value
// where low and high are equal.
struct Bin {
  double low;
  double high;

  bool Contains(double value) const { return value == low || (value > low && value < high); }
  // Returns "2 to 6", "1" for a single value, or "14 and more" for a range without an upper end.
  std::string Label() const {
    if (low == high) return fmt::format("{:g}", low);
    return high == std::numeric_limits<double>::infinity() ? fmt::format("{:g} and more", low)
                                                           : fmt::format("{:g} to {:g}", low, high);
  }
};

// Heights of the camera above the pattern (m): those of the paper's Table 2, and greater ones.
inline constexpr std::array<Bin, 5> kAltitudeBins{
    {{0, 2}, {2, 6}, {6, 9}, {9, 14}, {14, std::numeric_limits<double>::infinity()}}};

}  // namespace kestrel
