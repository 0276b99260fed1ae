// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/mapping/object_fusion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/vision/mapping/test_map.h"

namespace kestrel {
namespace {

using ::testing::ElementsAre;
using ::testing::SizeIs;

// A map of a standing disc at (1, 2) and one at (x, 2), seen five times.
std::vector<MappedObject> MapOfTwo(double x, Random* random) {
  ObjectMap map(DefaultObjectModel(), {});
  for (int i = 0; i < 5; ++i) {
    map.Update(Time(DurationFromSeconds(i)),
               std::vector{MeasureNoisily({1, 2, 0}, 0, 0.1, random),
                           MeasureNoisily({x, 2, 0}, 0, 0.1, random)},
               SeesAll());
  }
  return map.objects();
}

TEST(FuseObjects, FusesSameObjectOfTwoMaps) {
  Random random(2);
  std::vector<MappedObject> fused;
  const std::vector<MappedObject> first = MapOfTwo(8, &random);
  EXPECT_THAT(FuseObjects(first, &fused), ElementsAre(0, 1));
  EXPECT_THAT(FuseObjects(MapOfTwo(-8, &random), &fused), ElementsAre(0, 2));
  ASSERT_THAT(fused, SizeIs(3));
  EXPECT_EQ(fused[0].detections, 10);
  EXPECT_LT(fused[0].sigma_m(), 0.8 * first[0].sigma_m());
  EXPECT_LT((fused[0].position() - Eigen::Vector3d(1, 2, 0)).norm(), 0.1);
}

TEST(FuseObjects, KeepsObjectsOfOneMapSeparate) {
  Random random(3);
  std::vector<MappedObject> objects = MapOfTwo(8, &random);
  objects[1] = objects[0];
  std::vector<MappedObject> fused;
  FuseObjects(objects, &fused);
  EXPECT_THAT(fused, SizeIs(2));
}

// A yellow disc at x = 'x' that one map reports as moving or standing.
MappedObject Yellow(double x, double move_log_odds) {
  MappedObject object;
  object.may_move = true;
  object.moves = move_log_odds > 0;
  object.move_log_odds = move_log_odds;
  object.color_log_likelihoods[kYellow] = 5;
  object.state.head<4>() << x, 0, 0, object.moves ? 0.6 : 0;
  object.covariance.diagonal().setConstant(0.01);
  return object;
}

TEST(FuseObjects, SurerObjectDecidesWhetherFusedOneMoves) {
  std::vector<MappedObject> fused = {Yellow(0, -2)};
  FuseObjects({Yellow(0.1, 6)}, &fused);
  ASSERT_THAT(fused, SizeIs(1));
  EXPECT_TRUE(fused[0].moves);
  EXPECT_EQ(fused[0].velocity().x(), 0.6);
  fused = {Yellow(0, -6)};
  FuseObjects({Yellow(0.1, 2)}, &fused);
  EXPECT_FALSE(fused[0].moves);
  EXPECT_EQ(fused[0].velocity().x(), 0);
  EXPECT_EQ(fused[0].move_log_odds, -4);
}

}  // namespace
}  // namespace kestrel
