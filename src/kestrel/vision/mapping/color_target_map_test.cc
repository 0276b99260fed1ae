// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/mapping/color_target_map.h"

#include <gtest/gtest.h>

namespace kestrel {
namespace {

ColorTarget TargetAt(double x, const Eigen::Vector2d& likelihoods) {
  ColorTarget target;
  target.position = {x, 0, 0};
  target.score_likelihoods = likelihoods;
  target.color = {200, 10 * x, 0};
  return target;
}

TEST(ColorTargetMap, AveragesNearDetectionsAndAddsFarOnes) {
  ColorTargetMap map(1.0);
  map.Update(std::vector<ColorTarget>{TargetAt(0, {0.9, 0.1})});
  map.Update(std::vector<ColorTarget>{TargetAt(0.6, {0.2, 0.8}), TargetAt(5, {0.5, 0.5})});
  map.Update(std::vector<ColorTarget>{TargetAt(0.3, {0.2, 0.8})});
  ASSERT_EQ(map.objects().size(), 2U);
  const ColorTarget& first = map.objects()[0];
  EXPECT_NEAR(first.position.x(), 0.3, 1e-12);
  EXPECT_NEAR(first.color.y(), 3, 1e-12);
  EXPECT_EQ(first.detections, 3);
  EXPECT_EQ(first.most_likely_score(), 1);
  EXPECT_EQ(map.objects()[1].detections, 1);
}

}  // namespace
}  // namespace kestrel
