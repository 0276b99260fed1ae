// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

namespace kestrel {

inline constexpr int kDigitCount = 10;

// Probability of each digit; their sum is 1. A 6 and a 9 are the same figure turned by a half turn,
// and nothing shows which way is up, so both are equally likely.
using DigitLikelihoods = std::array<double, kDigitCount>;

// The likeliest digit and its probability. Of a 6 and a 9 that are equally likely, it is the 6.
struct LikelyDigit {
  int digit = 0;
  double probability = 0;
};
LikelyDigit LikeliestDigit(const DigitLikelihoods& likelihoods);

}  // namespace kestrel
