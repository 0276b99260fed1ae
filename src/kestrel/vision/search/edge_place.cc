// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/search/edge_place.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace kestrel {

double EdgePlace(std::span<const float, kEdgeProfile> gray, double reach) {
  std::array<float, kEdgeProfile - 2> gradient;
  for (int i = 0; i + 2 < kEdgeProfile; ++i) {
    if (gray[i] < 0 || gray[i + 2] < 0) return NAN;
    gradient[i] = gray[i + 2] - gray[i];
  }
  const int steepest =
      static_cast<int>(std::max_element(gradient.begin(), gradient.end()) - gradient.begin());
  constexpr int kMiddle = static_cast<int>(gradient.size()) / 2;
  const int around =
      std::min(kMiddle, std::min(steepest, static_cast<int>(gradient.size()) - 1 - steepest));
  double sum = 0, moment = 0;
  for (int i = steepest - around; i <= steepest + around; ++i) {
    const double weight = std::max(0.0f, gradient[i]);
    sum += weight;
    moment += weight * (i - kMiddle);
  }
  constexpr float kLeastStep = 6;  // gray values across an edge
  if (sum < kLeastStep) return NAN;
  return moment / sum * 2 * reach / (kEdgeProfile - 1);
}

}  // namespace kestrel
