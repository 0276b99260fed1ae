// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <span>

#include "kestrel/core/base/robust_statistics.h"

namespace kestrel {

// Standard deviation of 'offsets' from the median of their magnitudes, to half a percent; 0 for
// none. Does not sort but bisects the bits of the median, because positive floats have the order of
// their bits.
inline double RobustScale(std::span<const float> offsets) {
  constexpr std::uint32_t kLeastBit = 1u << 15;  // eighth bit of the mantissa
  std::uint32_t median = 0;
  for (std::uint32_t bit = 1u << 30; bit >= kLeastBit; bit >>= 1) {
    const auto limit = std::bit_cast<float>(median | bit);
    std::uint32_t below = 0;
    for (const float offset : offsets) below += std::abs(offset) < limit ? 1 : 0;
    if (2 * below <= offsets.size()) median |= bit;
  }
  if (offsets.empty()) return 0;
  return kSigmaPerMedianMagnitude *
         static_cast<double>(std::bit_cast<float>(median | kLeastBit >> 1));
}

}  // namespace kestrel
