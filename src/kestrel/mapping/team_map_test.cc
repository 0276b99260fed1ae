// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/mapping/team_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/mapping/map_file.h"
#include "kestrel/mapping/test_map.h"

namespace kestrel {
namespace {

using ::testing::SizeIs;

std::vector<MappedObject> RandomObjects(Random* random) {
  ObjectMap map(DefaultObjectModel(), {});
  for (int i = 0; i < 4; ++i) {
    std::vector<ObjectMeasurement> seen;
    for (int k = 0; k < 5; ++k) {
      const auto color = static_cast<std::size_t>(random->Integer(0, 4));
      seen.push_back(MeasureNoisily({2.0 * k, 0, 0}, color, 0.1, random));
    }
    map.Update(Time(DurationFromSeconds(i)), seen, SeesAll());
  }
  return map.objects();
}

// Messages of three UAVs, some of them different ones under one version.
TeamMap RandomTeam(Random* random) {
  TeamMap team;
  for (const char* uav : {"a", "b", "c"}) {
    if (random->Chance(0.3)) continue;
    team.Put(uav, {static_cast<std::uint64_t>(random->Integer(1, 3)), RandomObjects(random)});
  }
  return team;
}

TeamMap Merged(TeamMap first, const TeamMap& second) {
  first.Merge(second);
  return first;
}

std::string TextOf(const TeamMap& team) {
  std::string text;
  for (const auto& [uav, map] : team.maps()) {
    text += uav + std::to_string(map.version) + PrintObjects(map.objects);
  }
  return text + PrintObjects(team.Fused({}));
}

TEST(TeamMap, MergeIsCommutativeAssociativeAndIdempotent) {
  Random random(1);
  for (int i = 0; i < 30; ++i) {
    const TeamMap a = RandomTeam(&random);
    const TeamMap b = RandomTeam(&random);
    const TeamMap c = RandomTeam(&random);
    EXPECT_EQ(TextOf(Merged(a, b)), TextOf(Merged(b, a)));
    EXPECT_EQ(TextOf(Merged(Merged(a, b), c)), TextOf(Merged(a, Merged(b, c))));
    EXPECT_EQ(TextOf(Merged(a, a)), TextOf(a));
    EXPECT_EQ(TextOf(Merged(Merged(a, b), b)), TextOf(Merged(a, b)));
  }
}

TEST(TeamMap, TheSameObjectOfTwoUavsIsOneAndBetterKnown) {
  TeamMap team;
  Random random(2);
  double sigma_m = 0;
  for (const char* uav : {"a", "b"}) {
    ObjectMap map(DefaultObjectModel(), {});
    for (int i = 0; i < 5; ++i) {
      map.Update(Time(DurationFromSeconds(i)),
                 std::vector{MeasureNoisily({1, 2, 0}, 0, 0.1, &random),
                             MeasureNoisily({uav[0] == 'a' ? 8.0 : -8.0, 2, 0}, 0, 0.1, &random)},
                 SeesAll());
    }
    sigma_m = map.objects()[0].sigma_m();
    team.Put(uav, {1, map.objects()});
  }
  const auto fused = team.Fused({});
  ASSERT_THAT(fused, SizeIs(3));
  EXPECT_EQ(fused[0].detections, 10);
  EXPECT_LT(fused[0].sigma_m(), 0.8 * sigma_m);
  EXPECT_LT((fused[0].position() - Eigen::Vector3d(1, 2, 0)).norm(), 0.1);
}

TEST(TeamMap, OlderMessagesChangeNothing) {
  Random random(3);
  TeamMap team;
  team.Put("a", {2, RandomObjects(&random)});
  const std::string before = TextOf(team);
  team.Put("a", {1, {}});
  EXPECT_EQ(TextOf(team), before);
  team.Put("a", {3, {}});
  EXPECT_THAT(team.Fused({}), SizeIs(0));
}

}  // namespace
}  // namespace kestrel
