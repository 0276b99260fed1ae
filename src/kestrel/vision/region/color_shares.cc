// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/region/color_shares.h"

#include <algorithm>
#include <numeric>

namespace kestrel {
namespace {

// Makes the sum 1; false where it is 0.
bool Normalize(std::vector<float>* counts) {
  const float sum = std::accumulate(counts->begin(), counts->end(), 0.0f);
  if (sum == 0) return false;
  for (float& count : *counts) count /= sum;
  return true;
}

}  // namespace

ColorShares::ColorShares(int colors)
    : inside_(colors),
      around_(colors),
      new_inside_(colors),
      new_around_(colors),
      probability_(colors) {}

void ColorShares::Restart() {
  std::ranges::fill(inside_, 0.0f);
  std::ranges::fill(around_, 0.0f);
  Learn(1, 1);
}

void ColorShares::Learn(float rate_inside, float rate_around) {
  if (Normalize(&new_inside_) && Normalize(&new_around_)) {
    for (std::size_t i = 0; i < inside_.size(); ++i) {
      inside_[i] += rate_inside * (new_inside_[i] - inside_[i]);
      around_[i] += rate_around * (new_around_[i] - around_[i]);
      probability_[i] = (inside_[i] + 0.5f * kUnknown) / (inside_[i] + around_[i] + kUnknown);
    }
  }
  std::ranges::fill(new_inside_, 0.0f);
  std::ranges::fill(new_around_, 0.0f);
}

}  // namespace kestrel
