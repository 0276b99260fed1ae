// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/alignment/part_shares.h"

#include <algorithm>

namespace kestrel {
namespace {

// Statistics of the shares of the quarters that are in view.
struct KnownShares {
  explicit KnownShares(const std::array<double, 4>& shares) {
    for (const double share : shares) {
      if (share < 0) continue;
      worst = std::min(worst, share);
      sum += share;
      ++count;
    }
  }

  double worst = 1;
  double sum = 0;
  int count = 0;
};

}  // namespace

PartShares::Means PartShares::MeansInView() const {
  const KnownShares arms(arm);
  const KnownShares rings(ring);
  Means means{0, 0, rings.worst};
  if (arms.count > 0) {
    means.worst_arm = arms.worst;
    means.arms = arms.sum / arms.count;
  }
  if (rings.count > 1) means.ring = (rings.sum - rings.worst) / (rings.count - 1);
  return means;
}

}  // namespace kestrel
