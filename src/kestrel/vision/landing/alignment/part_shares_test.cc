// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/alignment/part_shares.h"

#include <gtest/gtest.h>

namespace kestrel {
namespace {

TEST(PartShares, IgnoresPartsOutOfView) {
  PartShares shares;
  shares.arm = {0.8, -1, 0.4, -1};
  shares.ring = {0.9, 0.2, -1, 0.7};
  const PartShares::Means means = shares.MeansInView();
  EXPECT_DOUBLE_EQ(means.worst_arm, 0.4);
  EXPECT_DOUBLE_EQ(means.arms, 0.6);
  EXPECT_DOUBLE_EQ(means.ring, 0.8) << "without its worst quarter";
  shares.arm.fill(-1);
  shares.ring.fill(-1);
  EXPECT_EQ(shares.MeansInView().worst_arm, 0) << "arms must be seen";
  EXPECT_EQ(shares.MeansInView().arms, 0);
  EXPECT_EQ(shares.MeansInView().ring, 1);
}

}  // namespace
}  // namespace kestrel
