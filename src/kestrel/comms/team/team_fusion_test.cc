// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/team/team_fusion.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/comms/team/test_team.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/vision/mapping/map_file.h"

namespace kestrel {
namespace {

using ::testing::Each;
using ::testing::Eq;
using ::testing::SizeIs;

UavKey KeyOf(int uav) { return {std::string(1, static_cast<char>('a' + uav)), 1}; }

// Returns a UAV's part with the objects 'first' to 'last' of the field, in a world of its own,
// which changes a little with every version.
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

TEST(TeamFusion, IncrementalFusionEqualsFullFusion) {
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

// The first and the last world have nothing in common.
TEST(TeamFusion, AlignsWorldsThroughOtherUavs) {
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

// A hundred discs of three colours over 30 m, at least a metre apart.
std::vector<MappedObject> DenseField(std::uint64_t seed) {
  Random random(seed);
  std::vector<MappedObject> field = TestField(100, &random);
  for (MappedObject& object : field) {
    object.state *= 0.3;
    object.color_log_likelihoods = {};
    object.color_log_likelihoods[static_cast<std::size_t>(object.id) % 3] = 5;
  }
  return field;
}

// The UAV's navigation is wrong by a metre and two degrees.
WorldAlignment BiasOf(int uav) {
  WorldAlignment bias;
  bias.translation = {std::cos(1.26 * uav), std::sin(1.26 * uav), 0};
  bias.yaw = Radians(uav % 2 == 0 ? 2 : -2);
  return bias;
}

// Returns what one UAV of five has seen of the field that it flies over along x, in overlapping
// strips.
PartMessage StripOf(int uav, const UavKey& key, const WorldAlignment& bias, double reach_m,
                    const std::vector<MappedObject>& field, Random* random) {
  PartMessage part{key, {}, {1, Time(), {}}, {}};
  for (const MappedObject& truth : field) {
    if (std::abs(truth.position().y() - 3 - 6 * uav) > 6 || truth.position().x() > reach_m)
      continue;
    const Eigen::Vector3d noise{random->Normal(), random->Normal(), random->Normal()};
    MappedObject object = truth;
    object.state.head<3>() = bias * truth.position() + 0.03 * noise;
    part.contents.objects[object.id] = 1;
    part.objects.push_back(object);
  }
  return part;
}

// Counts how often each object of the field is in the map, within half a metre.
std::vector<int> CountIn(const std::vector<MappedObject>& map,
                         const std::vector<MappedObject>& field, const WorldAlignment& common) {
  std::vector<int> counts;
  for (const MappedObject& truth : field) {
    const Eigen::Vector3d place = common * truth.position();
    counts.push_back(static_cast<int>(std::count_if(map.begin(), map.end(), [&](const auto& seen) {
      return seen.color_index() == truth.color_index() && (seen.position() - place).norm() < 0.5;
    })));
  }
  return counts;
}

// The objects that it saw before cannot be aligned, or only by chance, and nobody corrects them any
// more.
TEST(TeamFusion, ReturningUavLeavesNoDuplicates) {
  for (int seed = 1; seed <= 4; ++seed) {
    for (int dead = 0; dead < 5; ++dead) {
      for (const double reach_m : {0.5, 1.0, 2.0, 4.0, 8.0}) {
        for (const std::uint32_t boot : {0u, 9u}) {  // sorted by key before or after its other life
          Random random(static_cast<std::uint64_t>(seed));
          const std::vector<MappedObject> field = DenseField(static_cast<std::uint64_t>(seed));
          TeamMap map;
          for (int uav = 0; uav < 5; ++uav) {
            const WorldAlignment bias = BiasOf(uav == dead ? uav + 2 : uav);
            map.Merge(StripOf(uav, KeyOf(uav), bias, 100, field, &random), Time());
          }
          map.Merge(StripOf(dead, {KeyOf(dead).name, boot}, BiasOf(dead), reach_m, field, &random),
                    Time());
          TeamFusion fusion({}, {});
          fusion.Update(map);
          EXPECT_EQ(fusion.standing().size(), 100u) << seed << ' ' << dead << ' ' << reach_m;
          const WorldAlignment common = BiasOf(dead == 0 ? 2 : 0);
          EXPECT_THAT(CountIn(fusion.standing(), field, common), Each(Eq(1)))
              << seed << ' ' << dead << ' ' << reach_m;
        }
      }
    }
  }
}

TEST(TeamFusion, EmptyMapIsIgnored) {
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
