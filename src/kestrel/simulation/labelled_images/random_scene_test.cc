// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/labelled_images/random_scene.h"

#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;

constexpr double kRadius_m = 0.5;

TEST(RandomSceneTest, ZeroWearKeepsSceneAndRandomNumbers) {
  Random random(7), untouched(7);
  Scene scene;
  AddRandomWear({0, 0}, kRadius_m, 0, &random, &scene);
  EXPECT_TRUE(scene.layers.empty());
  EXPECT_EQ(random.Bits(), untouched.Bits());
}

TEST(RandomSceneTest, StainsLieOnPrintAndIncreaseWithWear) {
  const Vector2d center(2, -1);
  std::size_t little = 0, much = 0;
  for (int seed = 0; seed < 50; ++seed) {
    for (const double wear : {0.3, 1.0}) {
      Random random(seed);
      Scene scene;
      AddRandomWear(center, kRadius_m, wear, &random, &scene);
      (wear < 1 ? little : much) += scene.layers.size();
      for (const PaintLayer& layer : scene.layers) {
        EXPECT_LT(layer.shape.NearestEdge(center).distance, 1.2 * kRadius_m);
        EXPECT_GE(layer.reflectance, 0.1);
        EXPECT_LE(layer.reflectance, 0.9);
      }
    }
  }
  EXPECT_GT(little, 25u);
  EXPECT_GT(much, 2 * little);
}

}  // namespace
}  // namespace kestrel
