// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/labelled_images/relief.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace kestrel {
namespace {

// Returns a point of the sheet, in units of half its sides, -1 to 1.
Eigen::Vector2d At(const Relief& relief, double across, double along) {
  const double half = 0.5 * relief.size_m;
  return half * std::sqrt(0.5) * (across * Eigen::Vector2d(1, 1) + along * Eigen::Vector2d(-1, 1));
}

TEST(Relief, IsFlatWithoutHeights) {
  const Relief flat;
  EXPECT_TRUE(flat.IsFlat());
  EXPECT_EQ(flat.HeightAt({0.1, 0.2}), 0);
}

TEST(Relief, BulgeIsHighestInMiddleAndEndsAtRim) {
  for (const double bulge_m : {0.045, -0.045}) {
    const Relief relief{1.5, bulge_m, 0};
    EXPECT_FALSE(relief.IsFlat());
    EXPECT_NEAR(relief.HeightAt({0, 0}), bulge_m, 1e-12);
    for (double t = -1.2; t <= 1.2; t += 0.1) {
      EXPECT_LE(std::abs(relief.HeightAt(At(relief, t, 0.3))), std::abs(bulge_m));
      EXPECT_NEAR(relief.HeightAt(At(relief, 1, t)), 0, 1e-12);
      EXPECT_NEAR(relief.HeightAt(At(relief, t, -1)), 0, 1e-12);
    }
    EXPECT_EQ(relief.HeightAt(At(relief, 1.1, 0)), 0) << "beside the sheet";
  }
}

// Two creases in each direction, one up and one down, with straight lines between them.
TEST(Relief, FoldHasCreasesAtThirds) {
  const Relief relief{1.5, 0, 0.03};
  const auto height = [&](double across) { return relief.HeightAt(At(relief, across, 0)); };
  EXPECT_NEAR(height(1.0 / 3), 0.015, 1e-12);
  EXPECT_NEAR(height(-1.0 / 3), -0.015, 1e-12);
  EXPECT_NEAR(height(0), 0, 1e-12);
  EXPECT_NEAR(height(1.0 / 6), 0.5 * height(1.0 / 3), 1e-12);
  EXPECT_NEAR(height(2.0 / 3), 0.5 * height(1.0 / 3), 1e-12);
  double highest = 0;
  for (double across = -1; across <= 1; across += 0.01) {
    for (double along = -1; along <= 1; along += 0.01) {
      highest = std::max(highest, std::abs(relief.HeightAt(At(relief, across, along))));
    }
  }
  EXPECT_NEAR(highest, 0.03, 1e-3) << "where two creases meet";
}

TEST(Relief, RefusesTooSteepRelief) {
  EXPECT_TRUE((Relief{1.5, 0.2, -0.2}.Validate().empty()));
  EXPECT_EQ((Relief{1.5, 0.5, -0.5}.Validate().size()), 2u);
  EXPECT_EQ((Relief{0, 0, 0}.Validate().size()), 1u);
}

}  // namespace
}  // namespace kestrel
