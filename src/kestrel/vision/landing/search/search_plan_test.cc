// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/search/search_plan.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <gtest/gtest.h>

namespace kestrel {
namespace {

TEST(SearchPlan, HasNoDuplicateStepAndNoUnusedPass) {
  std::set<std::pair<std::size_t, SearchMethod>> steps;
  std::set<std::size_t> passes;
  for (const SearchStep& step : kSteps) {
    ASSERT_LT(step.pass, kSearchPasses);
    EXPECT_TRUE(steps.emplace(step.pass, step.method).second);
    passes.insert(step.pass);
  }
  EXPECT_EQ(passes.size(), kSearchPasses);
}

TEST(SearchPlan, SearchesArcsOfRingsOfAllSizes) {
  for (double ring_px = 6; ring_px < 2000; ring_px *= 1.1) {
    EXPECT_TRUE(std::any_of(kSteps.begin(), kSteps.end(),
                            [&](const SearchStep& step) {
                              const SearchPass& pass = kPasses[step.pass];
                              return step.method == SearchMethod::kArcs &&
                                     pass.min_ring_px <= ring_px && ring_px <= pass.max_ring_px;
                            }))
        << ring_px << " px";
  }
}

// At the resolution of a pass, the smallest ring it searches for still has visible strokes.
TEST(SearchPlan, PassesResolveTheirSmallestRing) {
  for (const SearchPass& pass : kPasses) {
    EXPECT_GE(pass.min_ring_px / std::exp2(pass.image_level), 6);
    EXPECT_LT(pass.min_ring_px, pass.max_ring_px);
  }
}

// A step at a lower resolution costs a quarter.
TEST(SearchPlan, FullResolutionComesLast) {
  const auto is_full = [](const SearchStep& step) { return kPasses[step.pass].image_level == 0; };
  const auto first = std::find_if(kSteps.begin(), kSteps.end(), is_full);
  EXPECT_TRUE(std::all_of(first, kSteps.end(), [&](const SearchStep& step) {
    return is_full(step) || step.method == SearchMethod::kCutAreas;
  }));
}

}  // namespace
}  // namespace kestrel
