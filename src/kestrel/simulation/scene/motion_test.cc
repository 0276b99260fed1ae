// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/scene/motion.h"

#include <cmath>

#include <gtest/gtest.h>

namespace kestrel {
namespace {

TEST(MotionTest, WanderHasRequestedSpread) {
  Random random(4);
  const auto wander = Wander(2, 1, &random);
  double squares = 0;
  constexpr int kSamples = 20000;
  for (int i = 0; i < kSamples; ++i) squares += std::pow(wander(0.1 * i), 2);
  EXPECT_NEAR(std::sqrt(squares / kSamples), 2, 0.1);
}

}  // namespace
}  // namespace kestrel
