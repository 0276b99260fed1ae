// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/alignment/robust_scale.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"
#include "kestrel/core/base/robust_statistics.h"

namespace kestrel {
namespace {

TEST(RobustScale, MatchesMedianMagnitude) {
  Random random(1);
  for (const double sigma : {1e-3, 0.3, 1.0, 70.0}) {
    std::vector<float> offsets;
    for (int i = 0; i < 301; ++i) offsets.push_back(static_cast<float>(sigma * random.Normal()));
    for (int i = 0; i < 20; ++i) offsets[i] = 1e6f;
    const double scale = RobustScale(offsets);
    for (float& offset : offsets) offset = std::abs(offset);
    EXPECT_NEAR(scale / RobustSigmaInPlace(offsets), 1, 0.005) << sigma;
  }
}

TEST(RobustScale, UsesMiddleOneOfFewValues) {
  const std::vector<float> offsets{-5, 0.1f, -2, 100, 0.2f};
  EXPECT_NEAR(RobustScale(offsets) / kSigmaPerMedianMagnitude, 2, 0.01);
  EXPECT_EQ(RobustScale({}), 0);
}

}  // namespace
}  // namespace kestrel
