// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/team/team_fusion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/geometry/angles.h"
#include "kestrel/mapping/map_file.h"
#include "kestrel/team/test_team.h"

namespace kestrel {
namespace {

using ::testing::SizeIs;

UavKey KeyOf(int uav) { return {std::string(1, static_cast<char>('a' + uav)), 1}; }

// What a UAV tells of the objects 'first' to 'last' of the field in a world of its own, which
// changes a little with every version.
PartMessage PartOf(int uav, std::uint64_t version, const std::vector<MappedObject>& field,
                   std::size_t first, std::size_t last) {
  Random random(static_cast<std::uint64_t>(uav) * 100 + version);
  WorldAlignment world;
  world.translation = {0.4 * uav, -0.3 * uav, 0.01 * uav};
  world.yaw = Radians(0.5) * uav;
  PartMessage part{KeyOf(uav), {}, {version, Time(), {}}, {}};
  for (std::size_t i = first; i < last; ++i) {
    MappedObject object = field[i];
    object.state.head<3>() =
        world * object.position() + 0.03 * Eigen::Vector3d{random.Normal(), random.Normal(), 0};
    part.contents.objects[object.id] = version;
    part.objects.push_back(object);
  }
  return part;
}

std::vector<MappedObject> Field(std::uint64_t seed = 1) {
  Random random(seed);
  return TestField(60, &random);
}

TEST(TeamFusion, WhatIsKeptIsWhatIsWorkedOutAnew) {
  const std::vector<MappedObject> field = Field();
  TeamMap map;
  TeamFusion kept({}, {});
  for (std::uint64_t version = 1; version <= 3; ++version) {
    for (int uav = 0; uav < 5; ++uav) {
      if (uav == 2 && version == 1) continue;  // comes later
      map.Merge(PartOf(uav, version, field, 5 * uav, 40), Time());
      kept.Update(map);
      TeamFusion fresh({}, {});
      fresh.Update(map);
      ASSERT_EQ(PrintObjects(kept.standing()), PrintObjects(fresh.standing()));
      for (const auto& [key, part] : map.parts()) {
        EXPECT_EQ(kept.IndicesOf(key), fresh.IndicesOf(key));
        EXPECT_EQ(kept.CommonFromWorld(key), fresh.CommonFromWorld(key));
      }
    }
  }
  EXPECT_THAT(kept.standing(), SizeIs(40));
  EXPECT_EQ(kept.IndicesOf(KeyOf(0))[20], kept.IndicesOf(KeyOf(4))[0]);
}

// The first and the last have nothing in common.
TEST(TeamFusion, WorldsAreAlignedByWayOfOthers) {
  const std::vector<MappedObject> field = Field();
  TeamMap map;
  map.Merge(PartOf(0, 1, field, 0, 20), Time());
  map.Merge(PartOf(1, 1, field, 30, 50), Time());
  TeamFusion fusion({}, {});
  fusion.Update(map);
  EXPECT_FALSE(fusion.IsPlaced(KeyOf(1)));
  map.Merge(PartOf(2, 1, field, 10, 40), Time());
  fusion.Update(map);
  EXPECT_TRUE(fusion.IsPlaced(KeyOf(1)));
  ASSERT_THAT(fusion.standing(), SizeIs(50));
  for (const int uav : {1, 2}) {
    const MappedObject seen = PartOf(uav, 1, field, 35, 36).objects[0];
    EXPECT_LT((fusion.CommonFromWorld(KeyOf(uav)) * Eigen::Vector3d(seen.position()) -
               field[35].position())
                  .norm(),
              0.3);
  }
}

TEST(TeamFusion, AMapThatIsEmptyIsNone) {
  const std::vector<MappedObject> field = Field();
  TeamMap map;
  map.Merge(PartOf(0, 1, field, 0, 0), Time());
  map.Merge(PartOf(1, 1, field, 0, 2), Time());
  TeamFusion fusion({}, {});
  fusion.Update(map);
  EXPECT_TRUE(fusion.IsPlaced(KeyOf(1)));
  EXPECT_THAT(fusion.standing(), SizeIs(2));
  map.Merge(PartOf(1, 2, field, 0, 0), Time());
  fusion.Update(map);
  EXPECT_THAT(fusion.standing(), SizeIs(0));
}

}  // namespace
}  // namespace kestrel
