// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace kestrel {

// Returns 64 random bits that depend only on the two numbers (splitmix64's mixing). Random values
// of pixels are therefore the same in whatever order the pixels are computed.
inline std::uint64_t Hash(std::uint64_t seed, std::uint64_t index) {
  std::uint64_t bits = seed + (index + 1) * 0x9E3779B97F4A7C15u;
  bits = (bits ^ (bits >> 30)) * 0xBF58476D1CE4E5B9u;
  bits = (bits ^ (bits >> 27)) * 0x94D049BB133111EBu;
  return bits ^ (bits >> 31);
}

}  // namespace kestrel
